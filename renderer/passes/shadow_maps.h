// Direct light in light space: variance shadow maps for directional, spot and point lights (through a cube).
#pragma once

#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/device_scene.h"
#include "renderer/passes/shadow_tints.h"
#include "renderer/passes/view_choice.h"
#include "renderer/scene/pose.h"

namespace lightwell {

/// Punctual lights and the moments of their depth, as shaders/lights.glsl reads them.
struct ShadowMaps {
  gl::Texture moments;  // RG32F, one layer a light (six a point light); half the rendered side unless unfiltered
  gl::Buffer lights;
  const gl::Texture* tints = nullptr;  // of ShadowTintsPass, where DeviceScene::has_tinted_shadows()
  void bind() const;
};

class ShadowMapsPass {
 public:
  explicit ShadowMapsPass(gl::ShaderLibrary& shaders);

  /// The side a light's view is rendered at, and the width of the box filter over it, in pixels. A filter of 2 or 3
  /// averages 2 x 2 pixels into a map of half the side, a wider one blurs that map as well; its bilinear sampling
  /// does the rest.
  void resize(int size_px, int filter_px, int layers);

  /// Number of layers that `pose`'s lights need; lights beyond MAX_SHADOW_LAYERS cast no shadow,
  /// those beyond MAX_LIGHTS do not shine.
  static int layers_for(const Pose& pose);

  const ShadowMaps& run(const DeviceScene& scene, const Pose& pose, const ViewChoice& choice);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p), clip_from_world(p, "light_clip_from_world"), position_far(p, "light_position_far") {}
    gl::ProgramPtr program;
    gl::Uniform<glm::mat4> clip_from_world;
    gl::Uniform<glm::vec4> position_far;
  };
  std::vector<LightView> place_lights(const Pose& pose);
  float cube_tangent() const;
  void draw(const DeviceScene& scene, const LightView& view);
  void draw_by_processor(ViewRasterizer& rasterizer, const LightView& view);
  int filter_radius() const;
  void filter_into(int layer);
  void filter_pass(const gl::Texture& from, const gl::Framebuffer& to, glm::ivec2 direction, int radius);

  Variant plain_, covered_, tinted_;
  gl::ProgramPtr from_depths_;
  gl::Uniform<int> from_depths_side_;
  gl::Buffer depths_{"depths of a light's rays", 0, gl::BufferUse::kHostVisible};
  gl::BufferTexture depth_texels_{"depths of a light's rays", GL_RG32F};
  ShadowTintsPass tints_pass_;
  gl::ProgramPtr filter_program_;
  gl::Uniform<glm::ivec2> filter_direction_;
  gl::Uniform<int> filter_radius_;
  gl::Uniform<glm::vec2> filter_texel_size_;
  gl::EmptyVertexArray full_screen_;
  ShadowMaps maps_;
  gl::Texture raw_, depth_;  // one light's view, before it is filtered into its layer
  gl::Texture half_[2];      // between the passes of a wide filter
  gl::Framebuffer raw_framebuffer_, half_framebuffers_[2];
  std::vector<gl::Framebuffer> layers_;
  int filter_px_ = 1;
};

}  // namespace lightwell
