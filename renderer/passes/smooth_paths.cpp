#include "renderer/passes/smooth_paths.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

// On the way of one path: a ball of glass has two, and more where light is reflected within it.
constexpr std::uint32_t kMostSurfaces = 6;

}  // namespace

SmoothPathsPass::SmoothPathsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_([&shaders](const gl::Defines& d) { return shaders.compute("passes/smooth_paths.comp", d); }),
      onward_("smooth paths", buffers) {}

gl::Defines SmoothPathsPass::defines(const DeviceScene& scene, Kind kind) {
  if (!is_needed(scene, kind)) return {};
  gl::Defines defines = gl::joined(scene.smooth_defines(), {"SMOOTH_PATHS 1"});
  if (kind == Kind::kMirrors) defines.emplace_back("MIRRORS_ALONE 1");
  return defines;
}

void SmoothPathsPass::run(FrameContext& frame, Kind kind, const SampleWave& wave, std::uint32_t count,
                          std::uint32_t pixels, std::uint32_t frame_number) {
  if (!is_needed(frame.scene, kind)) return;
  onward_.reserve(count);
  const gl::Defines defines = gl::joined(gl::joined(frame.scene.texture_defines(), frame.scene.brdf_defines()),
                                         SmoothPathsPass::defines(frame.scene, kind));
  Variant& first = variants_.with(gl::joined(defines, {"FIRST 1"}));
  Variant& next = variants_.with(defines);
  for (Variant* variant : {&first, &next}) {
    variant->pixel_count = pixels;
    variant->frame_number = frame_number;
    variant->most_bounces = static_cast<std::uint32_t>(frame.settings.bounces);
  }
  wave.ray_texels.bind(UNIT_RAYS);
  wave.hit_texels.bind(UNIT_HITS);
  frame.rays += onward_.follow(frame.tracer, count,
                               [&](std::uint32_t surface) { look(surface == 0 ? first : next, wave, count, surface); });
}

void SmoothPathsPass::look(Variant& variant, const SampleWave& wave, std::uint32_t count, std::uint32_t surface) {
  wave.hits.bind_storage(BINDING_HITS);
  wave.states.bind_storage(BINDING_SAMPLE_STATES);
  wave.rays.bind_storage(BINDING_RAYS);
  onward_.rays().bind_storage(BINDING_ARRIVING);
  variant.sample_count = count;
  variant.surface = surface;
  variant.goes_on = surface < kMostSurfaces ? 1 : 0;
  variant.program->dispatch(count);
}

}  // namespace lightwell
