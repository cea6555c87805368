#include "renderer/passes/hit_light.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

const gl::Defines kLiteral{"LITERAL 1"};

}  // namespace

void OcclusionMap::resize(std::uint32_t most_records) {
  hits.reserve(std::uint64_t{most_records} * sizeof(Hit));
  hit_texels.attach(hits);
  list.resize(most_records);
  arriving.reserve(std::uint64_t{most_records} * sizeof(glm::vec4));
  arriving_texels.attach(arriving);
}

void OcclusionMap::bind_cleared() const {
  if (cleared_texels) cleared_texels->bind(UNIT_CLEARED);
}

gl::Defines OcclusionMap::clear_defines() const {
  return cleared_texels ? gl::Defines{"CLEAR_SURFACES 1"} : gl::Defines{};
}

HitLightPass::HitLightPass(gl::ShaderLibrary& shaders)
    : from_lights_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/hit_light.comp", defines); }),
      from_screen_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/screen_light.comp", defines); }) {}

void HitLightPass::dispatch(Variant& variant, const OcclusionRays& rays, const OcclusionMap& occlusion) const {
  rays.directions.ray_texels.bind(UNIT_RAYS);
  rays.directions.direction_texels.bind(UNIT_DIRECTIONS);
  rays.patches.origin_texels.bind(UNIT_PIXEL_ORIGINS);
  occlusion.hits.bind_storage(BINDING_HITS);
  occlusion.hit_texels.bind(UNIT_HITS);
  occlusion.list.dispatch.bind_storage(BINDING_HIT_DISPATCH);
  occlusion.list.texels.bind(UNIT_HIT_LIST);
  occlusion.arriving.bind_storage(BINDING_ARRIVING);
  occlusion.bind_cleared();
  variant.slot_count = rays.slots;
  variant.patch_count = rays.patches.count;
  variant.program->dispatch_indirect(occlusion.list.dispatch);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void HitLightPass::run(const DeviceScene& scene, const OcclusionRays& rays, const OcclusionMap& occlusion,
                       const ShadowMaps& shadows, bool literal) {
  shadows.bind();
  gl::Defines defines = gl::joined(gl::joined(scene.texture_defines(), scene.light_defines()), scene.brdf_defines());
  defines = gl::joined(gl::joined(defines, rays.patches.defines()), occlusion.clear_defines());
  dispatch(from_lights_.with(literal ? gl::joined(defines, kLiteral) : defines), rays, occlusion);
}

void HitLightPass::run_from_screen(const GBuffer& g_buffer, const OcclusionRays& rays, const OcclusionMap& occlusion,
                                   const gl::Texture& previous_bounce) {
  g_buffer.bind();
  previous_bounce.bind(UNIT_IMAGE_A);
  dispatch(from_screen_.with(gl::joined(rays.patches.defines(), occlusion.clear_defines())), rays, occlusion);
}

}  // namespace lightwell
