#include "renderer/passes/firefly_clamp.h"

#include <cstring>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr std::uint32_t kGroup = 64;

// As in passes/firefly_sums.comp.
struct Totals {
  float mean, frames, fresh, removed, brought;
};

}  // namespace

FireflyClampPass::Clamp::Clamp(const gl::ProgramPtr& p)
    : program(p),
      sums(p),
      first_direct(p, "first_direct"),
      part_count(p, "part_count"),
      firefly_clamp(p, "firefly_clamp") {}

FireflyClampPass::FireflyClampPass(gl::ShaderLibrary& shaders)
    : clamp_([&shaders](const gl::Defines& d) { return shaders.compute("passes/firefly_clamp.comp", d); }),
      sums_([&shaders](const gl::Defines& d) { return shaders.compute("passes/firefly_sums.comp", d); }),
      parts_("parts of the light of samples", 0),
      totals_("light of samples, added up", sizeof(Totals), gl::BufferUse::kHostVisible) {
  totals_.clear();
}

void FireflyClampPass::run_over_map(FrameContext& frame, const GBuffer& g_buffer, const PatchSamples& samples,
                                    const PatchGrid& grid, float kept_frames) {
  is_new_ = false;
  g_buffer.bind();
  const gl::Defines defines = gl::joined(frame.scene.brdf_defines(), frame.scene.smooth_defines());
  for (const bool measures : {true, false}) {
    const gl::Defines step = measures ? gl::Defines{"MEASURE 1"} : gl::Defines{};
    Clamp& clamp = clamp_.with(gl::joined(defines, step));
    clamp.sums.set(grid, samples);
    clamp.firefly_clamp = frame.settings.firefly_clamp;
    Sums& sums = sums_.with(step);
    sums.kept_frames = kept_frames;
    dispatch(clamp, sums, *samples.light_buffer, grid);
  }
  frame.timer.mark("firefly clamp");
}

void FireflyClampPass::run_over_pixels(const FrameContext& frame, const gl::Buffer& light, const PatchGrid& grid,
                                       bool lamps_sampled, const gl::Defines& defines) {
  Clamp& clamp = clamp_.with(gl::joined(gl::joined(frame.scene.brdf_defines(), frame.scene.smooth_defines()), defines));
  clamp.sums.set(grid, lamps_sampled);
  clamp.firefly_clamp = frame.settings.firefly_clamp;
  dispatch(clamp, sums_.with({}), light, grid);
}

void FireflyClampPass::dispatch(Clamp& clamp, Sums& sums, const gl::Buffer& light, const PatchGrid& grid) {
  constexpr GLbitfield kBetween =
      GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT;
  const std::uint32_t parts = (grid.samples() + kGroup - 1) / kGroup;
  parts_.reserve(parts * sizeof(glm::vec2));
  light.bind_storage(BINDING_SAMPLE_LIGHT);
  parts_.bind_storage(BINDING_FIREFLY_PARTS);
  totals_.bind_storage(BINDING_FIREFLY_SUMS);
  clamp.first_direct = first_direct(grid);
  clamp.part_count = parts;
  clamp.program->dispatch(grid.samples(), kGroup);
  glMemoryBarrier(kBetween);
  sums.part_count = parts;
  sums.program->dispatch(1u, 1u);
  glMemoryBarrier(kBetween);
}

float FireflyClampPass::share() const {
  if (is_new_) return 0.0f;
  Totals totals;
  std::memcpy(&totals, totals_.host(), sizeof totals);
  return totals.brought > 0.0f ? totals.removed / totals.brought : 0.0f;
}

void FireflyClampPass::forget() {
  if (is_new_) return;
  totals_.clear();
  is_new_ = true;
}

}  // namespace lightwell
