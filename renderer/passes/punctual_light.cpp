#include "renderer/passes/punctual_light.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr std::uint32_t kMostExactLights = 4;

std::uint32_t pixels_of(glm::ivec2 size_px) {
  return static_cast<std::uint32_t>(size_px.x) * static_cast<std::uint32_t>(size_px.y);
}

}  // namespace

PunctualLightPass::PunctualLightPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/punctual_light.comp", defines); }),
      buffers_(buffers),
      clear_shadows_(shaders, buffers),
      rays_("punctual shadow rays", 0, buffers) {
  traced_.light = gl::Buffer("punctual light", 0);
  traced_.visible = gl::Buffer("visible punctual lights", 0, buffers);
}

void PunctualLightPass::resize(glm::ivec2 size_px) {
  const std::uint64_t pixels = pixels_of(size_px);
  rays_.reserve(pixels * sizeof(Ray));
  traced_.light.reserve(pixels * sizeof(glm::vec4));
  traced_.visible.reserve((pixels + 31) / 32 * sizeof(std::uint32_t));
  traced_.light_texels.attach(traced_.light);
  traced_.visible_texels.attach(traced_.visible);
}

const TracedLight& PunctualLightPass::run(FrameContext& frame, const GBuffer& g_buffer, const LightTable& lights,
                                          std::uint32_t frame_number) {
  if (!lights.has_punctual()) {
    traced_.light.clear();
    return traced_;
  }
  gl::Defines defines = gl::joined(frame.scene.brdf_defines(), {"LIGHTS_PUNCTUAL 1"});
  if (lights.counts().punctual <= kMostExactLights)
    defines.emplace_back("EXACT_LIGHTS " + std::to_string(lights.counts().punctual));
  Variant& variant = variants_.with(defines);
  variant.lights.set(lights.counts());
  variant.frame_number = frame_number;
  variant.seed = frame.settings.seed;
  g_buffer.bind();
  rays_.bind_storage(BINDING_SAMPLE_SHADOW_RAYS);
  traced_.light.bind_storage(BINDING_SAMPLE_LIGHT);
  variant.program->dispatch(frame.size_px);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  frame.timer.mark("direct light");
  clear_shadows_.run(frame, rays_, pixels_of(frame.size_px), traced_.visible, {traced_.light}, false);
  frame.rays += pixels_of(frame.size_px);
  frame.timer.mark("shadows");
  return traced_;
}

}  // namespace lightwell
