#include "renderer/passes/clear_layers.h"

namespace lightwell {

void draw_clear_layers(const DeviceScene& scene, const gl::Framebuffer& framebuffer) {
  framebuffer.bind();
  const GLfloat nothing[4] = {0.0f, 0.0f, 0.0f, 1.0f};
  glClearNamedFramebufferfv(framebuffer.id(), GL_COLOR, 0, nothing);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquationSeparate(GL_FUNC_ADD, GL_MIN);
  scene.draw([](DrawGroup) {});
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
}

ClearLayersPass::ClearLayersPass(gl::ShaderLibrary& shaders)
    : variants_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/g_buffer.vert", "passes/clear_layers.frag", defines);
      }) {}

void ClearLayersPass::resize(glm::ivec2 size_px) {
  if (layers_ && layers_.size_px() == size_px) return;
  layers_ = gl::Texture("clear layers", GL_RGBA32F, size_px);
  framebuffer_ = gl::Framebuffer("clear layers", {&layers_}, nullptr);
}

const gl::Texture& ClearLayersPass::run(const DeviceScene& scene, const GBuffer& behind) {
  behind.bind();
  variants_.with(gl::joined(scene.texture_defines(), scene.lobe_defines()))->use();
  draw_clear_layers(scene, framebuffer_);
  return layers_;
}

}  // namespace lightwell
