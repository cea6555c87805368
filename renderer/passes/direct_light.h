// Direct light at every pixel (thesis 4.1).
#pragma once

#include "renderer/gl/program.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/shadow_maps.h"

namespace lightwell {

/// Scene-referred light per pixel: emission and reflected punctual light; a = 1 on surfaces.
struct DirectRadiance {
  gl::Texture image;  // RGBA32F
};

class DirectLightPass {
 public:
  explicit DirectLightPass(gl::ShaderLibrary& shaders);
  void resize(glm::ivec2 size_px);
  const DirectRadiance& run(const GBuffer& g_buffer, const ShadowMaps& shadows);

 private:
  gl::ProgramPtr program_;
  DirectRadiance radiance_;
};

}  // namespace lightwell
