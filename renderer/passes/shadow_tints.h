// Shadows with a colour: what clear and blended surfaces let through of each light.
#pragma once

#include <vector>

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/device_scene.h"

namespace lightwell {

/// How a light sees the scene in one layer of its shadow map.
struct LightView {
  glm::mat4 clip_from_world;
  glm::vec4 position_far;     // w: the distance of depth 1; 0 for a directional light
  glm::vec4 direction_range;  // the way a directional light shines; metres between depth 0 and 1
};

class ShadowTintsPass {
 public:
  explicit ShadowTintsPass(gl::ShaderLibrary& shaders);

  /// `map_px` is `view_px` or half of it; `radius`: of the box filter, in texels of the map.
  void resize(glm::ivec2 view_px, glm::ivec2 map_px, int layers, int radius);

  /// Fills a layer. `opaque_moments`: of the same view, not filtered.
  void run(const DeviceScene& scene, const gl::Texture& opaque_moments, const LightView& view, int layer);

  /// RGBA16F: what passes; the depth of the nearest surface that lets light through, 1 where there is none.
  const gl::Texture& tints() const { return tints_; }

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p),
          clip_from_world(p, "light_clip_from_world"),
          position_far(p, "light_position_far"),
          direction_range(p, "light_direction_range") {}
    gl::ProgramPtr program;
    gl::Uniform<glm::mat4> clip_from_world;
    gl::Uniform<glm::vec4> position_far, direction_range;
  };
  gl::Variants<Variant> variants_;
  gl::ProgramPtr filter_program_;
  gl::Uniform<int> filter_scale_, filter_radius_;
  gl::EmptyVertexArray full_screen_;
  gl::Texture layers_, tints_;
  gl::Framebuffer layers_framebuffer_;
  std::vector<gl::Framebuffer> tint_framebuffers_;
  int radius_ = 0;
};

}  // namespace lightwell
