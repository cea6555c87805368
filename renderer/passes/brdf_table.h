// What the microfacet lobes reflect of uniform light, for the shader variants that conserve it.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"

namespace lightwell {

/// The table that shaders/brdf.glsl reads in its variants MULTISCATTER and HAS_LOBES. Integrated on the device when it
/// is bound for the first time, the same for all scenes.
class BrdfTable {
 public:
  explicit BrdfTable(gl::ShaderLibrary& shaders) : shaders_(shaders) {}
  void bind();

 private:
  gl::ShaderLibrary& shaders_;
  gl::Buffer table_;
  gl::BufferTexture texels_{"BRDF table", GL_RGBA32F};
};

}  // namespace lightwell
