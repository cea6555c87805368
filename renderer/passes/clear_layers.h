// What lies before the opaque surfaces of a view and lets light through, summed up.
#pragma once

#include "renderer/gl/texture.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/device_scene.h"
#include "renderer/passes/g_buffer.h"

namespace lightwell {

/// Draws the scene by the program in use, a variant of clear_layers.frag, into a framebuffer of one RGBA32F texture:
/// optical depths add up in rgb, a keeps the least of all.
void draw_clear_layers(const DeviceScene& scene, const gl::Framebuffer& framebuffer);

/// Of the camera's view.
class ClearLayersPass {
 public:
  explicit ClearLayersPass(gl::ShaderLibrary& shaders);
  void resize(glm::ivec2 size_px);
  /// `behind`: what is opaque. RGBA32F: optical depths of the clear surfaces before it.
  const gl::Texture& run(const DeviceScene& scene, const GBuffer& behind);

 private:
  gl::Variants<gl::ProgramPtr> variants_;
  gl::Texture layers_;
  gl::Framebuffer framebuffer_;
};

}  // namespace lightwell
