#include "renderer/passes/g_buffer.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

void GBuffer::bind() const {
  surface.bind(UNIT_G_SURFACE);
  material.bind(UNIT_G_MATERIAL);
  emission.bind(UNIT_G_EMISSION);
  depth.bind(UNIT_G_DEPTH);
  if (lobes) lobes.bind(UNIT_G_LOBES);
}

GBufferPass::GBufferPass(gl::ShaderLibrary& shaders)
    : variants_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/g_buffer.vert", "passes/g_buffer.frag", defines);
      }) {}

void GBufferPass::resize(glm::ivec2 size_px) {
  if (buffer_.depth && buffer_.size_px() == size_px) return;
  buffer_.surface = gl::Texture("g-buffer surface", GL_RGBA32UI, size_px);
  buffer_.material = gl::Texture("g-buffer material", GL_RG32UI, size_px);
  buffer_.emission = gl::Texture("g-buffer emission", GL_RGBA16F, size_px);
  buffer_.depth = gl::Texture("g-buffer depth", GL_DEPTH_COMPONENT32F, size_px);
  buffer_.lobes = {};
  framebuffer_ = gl::Framebuffer("g-buffer", {&buffer_.surface, &buffer_.material, &buffer_.emission}, &buffer_.depth);
}

const GBuffer& GBufferPass::run(const DeviceScene& scene, std::uint32_t seed) {
  if (scene.has_lobes() && !buffer_.lobes) {
    buffer_.lobes = gl::Texture("g-buffer lobes", GL_RGBA32UI, buffer_.size_px());
    framebuffer_with_lobes_ = gl::Framebuffer(
        "g-buffer", {&buffer_.surface, &buffer_.material, &buffer_.emission, &buffer_.lobes}, &buffer_.depth);
  }
  const gl::Framebuffer& framebuffer = scene.has_lobes() ? framebuffer_with_lobes_ : framebuffer_;
  framebuffer.bind();
  const GLfloat nothing_there = 0.0f;  // where it stays, nobody looks at the other textures
  glClearNamedFramebufferfv(framebuffer.id(), GL_DEPTH, 0, &nothing_there);

  Variant& variant = variants_.with(gl::joined(scene.texture_defines(), scene.lobe_defines()));
  variant.program->use();
  variant.frame_seed = seed;
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glCullFace(GL_BACK);
  scene.draw([](DrawGroup group) {
    if (group == DrawGroup::kDoubleSided)
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    // The picture's rows run downwards, which turns every winding around.
    glFrontFace(group == DrawGroup::kCulledMirrored ? GL_CCW : GL_CW);
  });
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  return buffer_;
}

}  // namespace lightwell
