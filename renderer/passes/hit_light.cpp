#include "renderer/passes/hit_light.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

const std::vector<std::string> kGeneral = {"HAS_TEXTURES 1", "ALL_TEXTURES 1", "HAS_ENVIRONMENT_IMAGE 1",
                                           "MANY_LIGHTS 1"};
const std::vector<std::string> kLiteral = {"HAS_TEXTURES 1", "ALL_TEXTURES 1", "MANY_LIGHTS 1", "LITERAL 1"};

}  // namespace

HitLightPass::HitLightPass(gl::ShaderLibrary& shaders)
    : plain_(shaders.compute("passes/hit_light.comp")),
      many_lights_(shaders.compute("passes/hit_light.comp", {"MANY_LIGHTS 1"})),
      base_color_textures_(shaders.compute("passes/hit_light.comp", {"HAS_TEXTURES 1"})),
      general_(shaders.compute("passes/hit_light.comp", kGeneral)),
      literal_(shaders.compute("passes/hit_light.comp", kLiteral)),
      special_([&shaders](const std::vector<std::string>& defines) {
        return shaders.compute("passes/hit_light.comp", with_defines(kGeneral, defines));
      }),
      special_literal_([&shaders](const std::vector<std::string>& defines) {
        return shaders.compute("passes/hit_light.comp", with_defines(kLiteral, defines));
      }),
      screen_program_(shaders.compute("passes/screen_light.comp")),
      screen_ray_count_(screen_program_, "ray_count") {
  radiance_.radiance = gl::Buffer("hit radiance", 0);
}

void HitLightPass::resize(std::uint32_t most_rays) {
  radiance_.radiance.reserve(std::uint64_t{most_rays} * 8);
  radiance_.texels.attach(radiance_.radiance);
}

void HitLightPass::bind(const Directions& directions, const OcclusionMap& occlusion) const {
  directions.rays.bind_storage(BINDING_RAYS);
  occlusion.hits.bind_storage(BINDING_HITS);
  radiance_.radiance.bind_storage(BINDING_HIT_RADIANCE);
}

HitLightPass::Variant& HitLightPass::variant_for(const DeviceScene& scene, bool literal) {
  if (!scene.brdf_variant().plain()) return (literal ? special_literal_ : special_).at(scene.brdf_variant());
  if (literal) return literal_;
  if (scene.has_all_textures() || scene.has_environment_image()) return general_;
  if (scene.has_textures()) return scene.has_many_lights() ? general_ : base_color_textures_;
  return scene.has_many_lights() ? many_lights_ : plain_;
}

const HitRadiance& HitLightPass::run(const DeviceScene& scene, const Directions& directions,
                                     const OcclusionMap& occlusion, const ShadowMaps& shadows, bool literal) {
  bind(directions, occlusion);
  directions.ray_texels.bind(UNIT_RAYS);
  occlusion.hit_texels.bind(UNIT_HITS);
  shadows.bind();
  Variant& variant = variant_for(scene, literal);
  variant.ray_count = directions.ray_count;
  variant.program->dispatch(directions.ray_count);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  return radiance_;
}

const HitRadiance& HitLightPass::run_from_screen(const GBuffer& g_buffer, const Directions& directions,
                                                 const OcclusionMap& occlusion, const gl::Texture& previous_bounce) {
  bind(directions, occlusion);
  g_buffer.bind();
  previous_bounce.bind(UNIT_IMAGE_A);
  screen_ray_count_ = directions.ray_count;
  screen_program_->dispatch(directions.ray_count);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  return radiance_;
}

}  // namespace lightwell
