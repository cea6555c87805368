#include "renderer/passes/hit_light.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

const gl::Defines kLiteral{"LITERAL 1"};

}  // namespace

void OcclusionMap::resize(std::uint32_t most_rays) {
  hits.reserve(std::uint64_t{most_rays} * sizeof(Hit));
  hit_texels.attach(hits);
  list.resize(most_rays);
  hit_weights.reserve(std::uint64_t{most_rays} * sizeof(glm::vec4));
}

HitLightPass::HitLightPass(gl::ShaderLibrary& shaders)
    : from_lights_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/hit_light.comp", defines); }),
      from_screen_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/screen_light.comp", defines); }) {}

void HitLightPass::bind(const Directions& directions, const OcclusionMap& occlusion) const {
  directions.rays.bind_storage(BINDING_RAYS);
  directions.ray_texels.bind(UNIT_RAYS);
  directions.arriving.bind_storage(BINDING_ARRIVING);
  occlusion.hits.bind_storage(BINDING_HITS);
  occlusion.hit_texels.bind(UNIT_HITS);
  occlusion.list.dispatch.bind_storage(BINDING_HIT_DISPATCH);
  occlusion.list.texels.bind(UNIT_HIT_LIST);
  occlusion.hit_weights.bind_storage(BINDING_HIT_WEIGHTS);
}

void HitLightPass::run(const DeviceScene& scene, const OcclusionMap& occlusion, const ShadowMaps& shadows, bool literal,
                       Directions& directions) {
  bind(directions, occlusion);
  shadows.bind();
  const gl::Defines defines =
      gl::joined(gl::joined(scene.texture_defines(), scene.light_defines()), scene.brdf_defines());
  from_lights_.with(literal ? gl::joined(defines, kLiteral) : defines)->dispatch_indirect(occlusion.list.dispatch);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void HitLightPass::run_from_screen(const GBuffer& g_buffer, const OcclusionMap& occlusion,
                                   const gl::Texture& previous_bounce, bool literal, Directions& directions) {
  bind(directions, occlusion);
  g_buffer.bind();
  previous_bounce.bind(UNIT_IMAGE_A);
  from_screen_.with(literal ? kLiteral : gl::Defines{})->dispatch_indirect(occlusion.list.dispatch);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace lightwell
