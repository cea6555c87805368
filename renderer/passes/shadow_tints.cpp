#include "renderer/passes/shadow_tints.h"

#include "renderer/passes/bindings.glsl"
#include "renderer/passes/clear_layers.h"

namespace lightwell {

ShadowTintsPass::ShadowTintsPass(gl::ShaderLibrary& shaders)
    : variants_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/g_buffer.vert", "passes/clear_layers.frag", defines);
      }),
      filter_program_(shaders.raster("passes/full_screen.vert", "passes/shadow_tint.frag")),
      filter_scale_(filter_program_, "texels_per_texel"),
      filter_radius_(filter_program_, "radius") {}

void ShadowTintsPass::resize(glm::ivec2 view_px, glm::ivec2 map_px, int layers, int radius) {
  radius_ = radius;
  if (layers_ && layers_.size_px() == view_px && tints_.size_px() == map_px && tints_.layers() == layers) return;
  layers_ = gl::Texture("clear layers of a light", GL_RGBA32F, view_px);
  layers_framebuffer_ = gl::Framebuffer("clear layers of a light", {&layers_}, nullptr);
  gl::TextureOptions options;
  options.min_filter = options.mag_filter = GL_LINEAR;
  options.target = GL_TEXTURE_2D_ARRAY;
  options.layers = layers;
  tints_ = gl::Texture("shadow tints", GL_RGBA16F, map_px, options);
  tint_framebuffers_.clear();
  for (int layer = 0; layer < layers; ++layer)
    tint_framebuffers_.emplace_back("shadow tint", std::initializer_list<const gl::Texture*>{&tints_}, nullptr, layer);
}

void ShadowTintsPass::run(const DeviceScene& scene, const gl::Texture& opaque_moments, const LightView& view,
                          int layer) {
  opaque_moments.bind(UNIT_IMAGE_A);
  const Variant& variant =
      variants_.with(gl::joined(gl::joined(scene.texture_defines(), scene.lobe_defines()), {"LIGHT_VIEW 1"}));
  variant.program->use();
  variant.clip_from_world = view.clip_from_world;
  variant.position_far = view.position_far;
  variant.direction_range = view.direction_range;
  draw_clear_layers(scene, layers_framebuffer_);
  layers_.bind(0);
  filter_scale_ = layers_.size_px().x / tints_.size_px().x;
  filter_radius_ = radius_;
  tint_framebuffers_[static_cast<std::size_t>(layer)].bind();
  filter_program_->use();
  full_screen_.draw_full_screen();
}

}  // namespace lightwell
