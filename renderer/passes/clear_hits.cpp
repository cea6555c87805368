#include "renderer/passes/clear_hits.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

ClearHitsPass::ClearHitsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_([&shaders](const gl::Defines& defines) { return shaders.compute("passes/clear_hits.comp", defines); }),
      onward_("rays through clear surfaces", buffers),
      cleared_("clear surfaces before hits", 0) {}

void ClearHitsPass::resize(std::uint32_t most_records) {
  onward_.reserve(most_records);
  cleared_.reserve(std::uint64_t{most_records} * 2 * sizeof(glm::vec4));
  cleared_texels_.attach(cleared_);
}

std::uint64_t ClearHitsPass::run(const DeviceScene& scene, Tracer& tracer, const ShadowMaps& shadows,
                                 const OcclusionRays& rays, OcclusionMap& occlusion) {
  gl::Defines defines = gl::joined(gl::joined(scene.texture_defines(), scene.light_defines()), scene.brdf_defines());
  defines.emplace_back("CLEAR_RECEIVER 1");
  Variant& first = variants_.with(gl::joined(gl::joined(defines, rays.patches.defines()), {"FIRST 1"}));
  Variant& next = variants_.with(defines);
  shadows.bind();
  onward_.bind();
  rays.directions.ray_texels.bind(UNIT_RAYS);
  const std::uint32_t records = rays.slots * rays.directions.count;
  const std::uint64_t traced = onward_.follow(tracer, records, [&](std::uint32_t surface) {
    look(surface == 0 ? first : next, rays, occlusion, surface < MOST_CLEAR_SURFACES);
  });
  occlusion.cleared_texels = &cleared_texels_;
  return traced;
}

void ClearHitsPass::look(Variant& variant, const OcclusionRays& rays, const OcclusionMap& occlusion, bool goes_on) {
  rays.directions.direction_texels.bind(UNIT_DIRECTIONS);
  rays.patches.origin_texels.bind(UNIT_PIXEL_ORIGINS);
  occlusion.hits.bind_storage(BINDING_HITS);
  onward_.rays().bind_storage(BINDING_RAYS);
  cleared_.bind_storage(BINDING_ARRIVING);
  variant.slot_count = rays.slots;
  variant.patch_count = rays.patches.count;
  variant.record_count = rays.slots * rays.directions.count;
  variant.goes_on = goes_on ? 1 : 0;
  variant.program->dispatch(rays.slots * rays.directions.count);
}

}  // namespace lightwell
