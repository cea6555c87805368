#include "renderer/passes/clear_samples.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

ClearSamplesPass::ClearSamplesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_([&shaders](const gl::Defines& d) { return shaders.compute("passes/clear_samples.comp", d); }),
      onward_("samples through clear surfaces", buffers),
      tints_("tints of samples", 0) {}

gl::Defines ClearSamplesPass::defines(const DeviceScene& scene) {
  return scene.has_clear() ? gl::Defines{"CLEAR_SURFACES 1"} : gl::Defines{};
}

void ClearSamplesPass::run(FrameContext& frame, const SampleWave& wave, std::uint32_t count,
                           std::uint32_t frame_number) {
  if (!frame.scene.has_clear()) return;
  onward_.reserve(count);
  tints_.reserve(count * sizeof(glm::vec4));
  tint_texels_.attach(tints_);
  const gl::Defines defines = gl::joined(frame.scene.texture_defines(), frame.scene.brdf_defines());
  Variant& first = variants_.with(gl::joined(defines, {"FIRST 1"}));
  Variant& next = variants_.with(defines);
  first.frame_number = frame_number;
  next.frame_number = frame_number;
  wave.ray_texels.bind(UNIT_RAYS);
  wave.hit_texels.bind(UNIT_HITS);
  frame.rays += onward_.follow(frame.tracer, count,
                               [&](std::uint32_t surface) { look(surface == 0 ? first : next, wave, count, surface); });
  tint_texels_.bind(UNIT_CLEARED);
}

void ClearSamplesPass::look(Variant& variant, const SampleWave& wave, std::uint32_t count, std::uint32_t surface) {
  wave.hits.bind_storage(BINDING_HITS);
  onward_.rays().bind_storage(BINDING_RAYS);
  tints_.bind_storage(BINDING_ARRIVING);
  variant.sample_count = count;
  variant.surface = surface;
  variant.goes_on = surface < MOST_CLEAR_SURFACES ? 1 : 0;
  variant.program->dispatch(count);
}

}  // namespace lightwell
