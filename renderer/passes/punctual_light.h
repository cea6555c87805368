// Direct light of lights without a size, by traced shadow rays of every pixel.
#pragma once

#include "renderer/gl/variants.h"
#include "renderer/methods/frame_context.h"
#include "renderer/passes/clear_shadows.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/light_table.h"

namespace lightwell {

/// Per shadow ray what its light would give (vec4, nit), and a bit that says whether it reaches: row by row the first
/// rays of all pixels, then their second ones.
struct TracedLight {
  std::uint32_t rays_of_pixel = 0;
  /// For shaders that read it.
  std::string define() const { return "TRACED_LIGHT " + std::to_string(rays_of_pixel); }
  gl::Buffer light, visible;
  gl::BufferTexture light_texels{"punctual light", GL_RGBA32F};
  gl::BufferTexture visible_texels{"visible punctual lights", GL_R32UI};
};

class PunctualLightPass {
 public:
  /// `buffers`: where rays live; host-visible for a native tracer.
  PunctualLightPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// `lights` is bound. `frame_number` counts the frames of the view.
  const TracedLight& run(FrameContext& frame, const GBuffer& g_buffer, const LightTable& lights,
                         std::uint32_t frame_number);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p), lights(p), other_choices(p, "other_choices"), frame_number(p, "frame_number"), seed(p, "seed") {}
    gl::ProgramPtr program;
    LightTableUniforms lights;
    gl::Uniform<std::uint32_t> other_choices, frame_number, seed;
  };
  void reserve(std::uint64_t rays);

  gl::Variants<Variant> variants_;
  gl::BufferUse buffers_;
  ClearShadowsPass clear_shadows_;
  gl::Buffer rays_;
  TracedLight traced_;
};

}  // namespace lightwell
