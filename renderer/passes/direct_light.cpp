#include "renderer/passes/direct_light.h"

namespace lightwell {

DirectLightPass::DirectLightPass(gl::ShaderLibrary& shaders) : program_(shaders.compute("passes/direct_light.comp")) {}

void DirectLightPass::resize(glm::ivec2 size_px) {
  if (radiance_.image && radiance_.image.size_px() == size_px) return;
  radiance_.image = gl::Texture("direct radiance", GL_RGBA32F, size_px);
}

const DirectRadiance& DirectLightPass::run(const GBuffer& g_buffer, const ShadowMaps& shadows) {
  g_buffer.bind();
  shadows.bind();
  radiance_.image.bind_image(0, GL_WRITE_ONLY);
  program_->dispatch(radiance_.image.size_px());
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  return radiance_;
}

}  // namespace lightwell
