// From what another method has shown of a still view to the paths of `reference`, without a step.
#pragma once

#include "renderer/gl/program.h"
#include "renderer/passes/compose.h"

namespace lightwell {

/// Paths a pixel that have about the error of a still view's refined picture by `method`.
float worth_in_paths(Method method);

/// How much of the picture is that of `paths` a pixel, when all of it is to be at `frames`; 0..1, and 1 from there on.
/// The picture before counts for as many paths as it is worth, and for less and less as the end comes near.
float share_of_paths(std::uint32_t paths, std::uint32_t frames, float worth);

class HandOverPass {
 public:
  explicit HandOverPass(gl::ShaderLibrary& shaders);

  /// The mean of both, by `share_of_paths`; `frames`: when all is of the paths; `before`: by what method the picture
  /// before was made. Both pictures have one size.
  const Picture& run(const Picture& paths, const Picture& shown_before, Method before, std::uint32_t frames);

 private:
  gl::ProgramPtr program_;
  gl::Uniform<float> share_;
  Picture picture_;
  gl::Framebuffer framebuffer_;
  gl::EmptyVertexArray full_screen_;
};

}  // namespace lightwell
