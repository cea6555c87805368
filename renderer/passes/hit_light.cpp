#include "renderer/passes/hit_light.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

HitLightPass::HitLightPass(gl::ShaderLibrary& shaders)
    : plain_(shaders.compute("passes/hit_light.comp")),
      textured_(shaders.compute("passes/hit_light.comp", {"HAS_TEXTURES 1", "HAS_ENVIRONMENT_IMAGE 1"})),
      plain_literal_(shaders.compute("passes/hit_light.comp", {"LITERAL 1"})),
      textured_literal_(
          shaders.compute("passes/hit_light.comp", {"LITERAL 1", "HAS_TEXTURES 1", "HAS_ENVIRONMENT_IMAGE 1"})),
      screen_program_(shaders.compute("passes/screen_light.comp")),
      screen_ray_count_(screen_program_, "ray_count") {
  radiance_.radiance = gl::Buffer("hit radiance", 0);
}

void HitLightPass::resize(std::uint32_t most_rays) {
  radiance_.radiance.reserve(std::uint64_t{most_rays} * 8);
}

void HitLightPass::bind(const Directions& directions, const OcclusionMap& occlusion) const {
  directions.rays.bind_storage(BINDING_RAYS);
  occlusion.hits.bind_storage(BINDING_HITS);
  radiance_.radiance.bind_storage(BINDING_HIT_RADIANCE);
}

const HitRadiance& HitLightPass::run(const DeviceScene& scene, const Directions& directions,
                                     const OcclusionMap& occlusion, const ShadowMaps& shadows, bool literal) {
  bind(directions, occlusion);
  shadows.bind();
  Variant& variant = literal ? (scene.has_textures() ? textured_literal_ : plain_literal_)
                             : (scene.has_textures() ? textured_ : plain_);
  variant.ray_count = directions.ray_count;
  variant.program->dispatch(directions.ray_count);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  return radiance_;
}

const HitRadiance& HitLightPass::run_from_screen(const GBuffer& g_buffer, const Directions& directions,
                                                 const OcclusionMap& occlusion, const gl::Texture& previous_bounce) {
  bind(directions, occlusion);
  g_buffer.bind();
  previous_bounce.bind(UNIT_IMAGE_A);
  screen_ray_count_ = directions.ray_count;
  screen_program_->dispatch(directions.ray_count);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  return radiance_;
}

}  // namespace lightwell
