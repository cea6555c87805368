// Shadow rays, which clear surfaces let through with their tint.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/counter.h"
#include "renderer/gl/variants.h"
#include "renderer/methods/frame_context.h"

namespace lightwell {

/// Where the light lies that waits for shadow rays, as vec4 with anything in a: that of ray i at first + stride * i,
/// from ray `split` on at first_of_rest + i - split.
struct WaitingLight {
  const gl::Buffer& buffer;
  std::uint32_t first = 0, stride = 1, split = ~0u, first_of_rest = 0;
};

class ClearShadowsPass {
 public:
  /// `buffers`: host-visible for a native tracer.
  ClearShadowsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// As Tracer::any_hit, where the scene has no clear surfaces (walls, if `walls_only`). Where it has some: the light
  /// of rays that meet nothing else, and no more than MOST_CLEAR_SURFACES of them, is multiplied by what these let
  /// through, that of the others becomes 0, every bit of `visible` 1, and the rays are used up. Counts in `frame` the
  /// rays traced on, not the `count` first ones.
  void run(FrameContext& frame, gl::Buffer& rays, std::uint32_t count, gl::Buffer& visible, const WaitingLight& light,
           bool walls_only);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p),
          ray_count(p, "ray_count"),
          clear_flags(p, "clear_flags"),
          goes_on(p, "goes_on"),
          light_places(p, "light_places") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> ray_count, clear_flags;
    gl::Uniform<int> goes_on;
    gl::Uniform<glm::uvec4> light_places;
  };
  std::uint32_t step(const Variant& variant, std::uint32_t count, bool goes_on);

  gl::Variants<Variant> variants_;
  gl::Buffer hits_;
  gl::Counter onward_;
  gl::BufferTexture ray_texels_{"shadow rays", GL_RGBA32F};
  gl::BufferTexture hit_texels_{"hits of shadow rays", GL_RGBA32UI};
};

}  // namespace lightwell
