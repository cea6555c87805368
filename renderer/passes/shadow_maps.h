// Direct light in light space: variance shadow maps for directional, spot and point lights (through a cube).
#pragma once

#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/device_scene.h"
#include "renderer/scene/pose.h"

namespace lightwell {

/// Punctual lights and the moments of their depth, as shaders/lights.glsl reads them.
struct ShadowMaps {
  gl::Texture moments;  // RG32F, one layer a light (six a point light)
  gl::Buffer lights;
  void bind() const;
};

class ShadowMapsPass {
 public:
  explicit ShadowMapsPass(gl::ShaderLibrary& shaders);

  /// A map's side and its box filter's width in pixels.
  void resize(int size_px, int filter_px, int layers);

  /// Number of layers that `pose`'s lights need; lights beyond MAX_SHADOW_LAYERS cast no shadow,
  /// those beyond MAX_LIGHTS do not shine.
  static int layers_for(const Pose& pose);

  const ShadowMaps& run(const DeviceScene& scene, const Pose& pose);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p), clip_from_world(p, "light_clip_from_world"), position_far(p, "light_position_far") {}
    gl::ProgramPtr program;
    gl::Uniform<glm::mat4> clip_from_world;
    gl::Uniform<glm::vec4> position_far;
  };
  struct View {
    glm::mat4 clip_from_world;
    glm::vec4 position_far;  // w 0: directional
  };
  std::vector<View> place_lights(const Pose& pose);
  float cube_tangent() const;
  void draw(const DeviceScene& scene, const View& view, int layer);
  void filter(int layers);

  Variant plain_, textured_;
  gl::ProgramPtr filter_program_;
  gl::Uniform<glm::ivec2> filter_direction_;
  gl::Uniform<int> filter_radius_;
  ShadowMaps maps_;
  gl::Texture across_, depth_;
  std::vector<gl::Framebuffer> framebuffers_;
  int filter_px_ = 1;
};

}  // namespace lightwell
