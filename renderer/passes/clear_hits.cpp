#include "renderer/passes/clear_hits.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

ClearHitsPass::ClearHitsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_([&shaders](const gl::Defines& defines) { return shaders.compute("passes/clear_hits.comp", defines); }),
      rays_("rays through clear surfaces", 0, buffers),
      hits_("hits behind clear surfaces", 0, buffers),
      cleared_("clear surfaces before hits", 0),
      onward_("count of rays through clear surfaces") {}

void ClearHitsPass::resize(std::uint32_t most_records) {
  rays_.reserve(std::uint64_t{most_records} * sizeof(Ray));
  hits_.reserve(std::uint64_t{most_records} * sizeof(Hit) + 16);  // the last record is read as two wide texels
  cleared_.reserve(std::uint64_t{most_records} * 2 * sizeof(glm::vec4));
  ray_texels_.attach(rays_);
  hit_texels_.attach(hits_);
  cleared_texels_.attach(cleared_);
}

std::uint64_t ClearHitsPass::run(const DeviceScene& scene, Tracer& tracer, const ShadowMaps& shadows,
                                 const OcclusionRays& rays, OcclusionMap& occlusion) {
  gl::Defines defines = gl::joined(gl::joined(scene.texture_defines(), scene.light_defines()), scene.brdf_defines());
  defines.emplace_back("CLEAR_RECEIVER 1");
  const std::uint32_t records = rays.slots * rays.directions.count;
  Variant& first = variants_.with(gl::joined(gl::joined(defines, rays.patches.defines()), {"FIRST 1"}));
  Variant& next = variants_.with(defines);
  shadows.bind();
  rays.directions.ray_texels.bind(UNIT_RAYS);
  std::uint64_t traced = 0;
  std::uint32_t onward = step(first, rays, occlusion, true);
  ray_texels_.bind(UNIT_RAYS);
  for (int surface = 1; onward > 0; ++surface) {
    tracer.closest_hit(rays_, records, hits_);
    traced += onward;
    onward = step(next, rays, occlusion, surface < MOST_CLEAR_SURFACES);
  }
  occlusion.cleared_texels = &cleared_texels_;
  return traced;
}

// The number of rays that go on.
std::uint32_t ClearHitsPass::step(Variant& variant, const OcclusionRays& rays, const OcclusionMap& occlusion,
                                  bool goes_on) {
  onward_.begin(BINDING_OUTPUT);
  rays.directions.direction_texels.bind(UNIT_DIRECTIONS);
  rays.patches.origin_texels.bind(UNIT_PIXEL_ORIGINS);
  hit_texels_.bind(UNIT_HITS);
  occlusion.hits.bind_storage(BINDING_HITS);
  rays_.bind_storage(BINDING_RAYS);
  cleared_.bind_storage(BINDING_ARRIVING);
  variant.slot_count = rays.slots;
  variant.patch_count = rays.patches.count;
  variant.record_count = rays.slots * rays.directions.count;
  variant.goes_on = goes_on ? 1 : 0;
  variant.program->dispatch(rays.slots * rays.directions.count);
  return onward_.value();
}

}  // namespace lightwell
