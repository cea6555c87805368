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

}  // namespace lightwell
