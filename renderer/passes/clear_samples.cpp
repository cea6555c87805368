#include "renderer/passes/clear_samples.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

ClearSamplesPass::ClearSamplesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_([&shaders](const gl::Defines& d) { return shaders.compute("passes/clear_samples.comp", d); }),
      rays_("samples through clear surfaces", 0, buffers),
      hits_("hits behind clear surfaces", 0, buffers),
      tints_("tints of samples", 0),
      onward_("count of samples through clear surfaces") {}

gl::Defines ClearSamplesPass::defines(const DeviceScene& scene) {
  return scene.has_clear() ? gl::Defines{"CLEAR_SURFACES 1"} : gl::Defines{};
}

void ClearSamplesPass::run(FrameContext& frame, const SampleWave& wave, std::uint32_t count,
                           std::uint32_t frame_number) {
  if (!frame.scene.has_clear()) return;
  rays_.reserve(count * sizeof(Ray));
  hits_.reserve(std::uint64_t{count} * sizeof(Hit) + 16);  // the last record is read as two wide texels
  tints_.reserve(count * sizeof(glm::vec4));
  ray_texels_.attach(rays_);
  hit_texels_.attach(hits_);
  tint_texels_.attach(tints_);
  const gl::Defines defines = gl::joined(frame.scene.texture_defines(), frame.scene.brdf_defines());
  Variant& first = variants_.with(gl::joined(defines, {"FIRST 1"}));
  Variant& next = variants_.with(defines);
  first.frame_number = frame_number;
  next.frame_number = frame_number;
  wave.ray_texels.bind(UNIT_RAYS);
  wave.hit_texels.bind(UNIT_HITS);
  std::uint32_t onward = step(first, wave, count, 0);
  ray_texels_.bind(UNIT_RAYS);
  hit_texels_.bind(UNIT_HITS);
  for (std::uint32_t surface = 1; onward > 0; ++surface) {
    frame.tracer.closest_hit(rays_, count, hits_);
    frame.rays += onward;
    onward = step(next, wave, count, surface);
  }
  tint_texels_.bind(UNIT_CLEARED);
}

// The number of rays that go on.
std::uint32_t ClearSamplesPass::step(Variant& variant, const SampleWave& wave, std::uint32_t count,
                                     std::uint32_t surface) {
  onward_.begin(BINDING_OUTPUT);
  wave.hits.bind_storage(BINDING_HITS);
  rays_.bind_storage(BINDING_RAYS);
  tints_.bind_storage(BINDING_ARRIVING);
  variant.sample_count = count;
  variant.surface = surface;
  variant.goes_on = surface < MOST_CLEAR_SURFACES ? 1 : 0;
  variant.program->dispatch(count);
  return onward_.value();
}

}  // namespace lightwell
