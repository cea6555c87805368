#include "renderer/passes/smooth_paths.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

// On the way of one path: a ball of glass has two, and more where light is reflected within it.
constexpr std::uint32_t kMostSurfaces = 6;

}  // namespace

SmoothPathsPass::SmoothPathsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_([&shaders](const gl::Defines& d) { return shaders.compute("passes/smooth_paths.comp", d); }),
      rays_("smooth paths", 0, buffers),
      hits_("hits of smooth paths", 0, buffers),
      onward_("count of smooth paths") {}

gl::Defines SmoothPathsPass::defines(const DeviceScene& scene, Kind kind) {
  if (!is_needed(scene, kind)) return {};
  gl::Defines defines = gl::joined(scene.smooth_defines(), {"SMOOTH_PATHS 1"});
  if (kind == Kind::kMirrors) defines.emplace_back("MIRRORS_ALONE 1");
  return defines;
}

void SmoothPathsPass::run(FrameContext& frame, Kind kind, const SampleWave& wave, std::uint32_t count,
                          std::uint32_t pixels, std::uint32_t frame_number) {
  if (!is_needed(frame.scene, kind)) return;
  rays_.reserve(count * sizeof(Ray));
  hits_.reserve(std::uint64_t{count} * sizeof(Hit) + 16);  // the last record is read as two wide texels
  ray_texels_.attach(rays_);
  hit_texels_.attach(hits_);
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
  std::uint32_t onward = step(first, wave, count, 0);
  for (std::uint32_t surface = 1; onward > 0; ++surface) {
    frame.tracer.closest_hit(rays_, count, hits_);
    frame.rays += onward;
    ray_texels_.bind(UNIT_RAYS);
    hit_texels_.bind(UNIT_HITS);
    onward = step(next, wave, count, surface);
  }
}

// The number of rays that go on.
std::uint32_t SmoothPathsPass::step(Variant& variant, const SampleWave& wave, std::uint32_t count,
                                    std::uint32_t surface) {
  onward_.begin(BINDING_OUTPUT);
  wave.hits.bind_storage(BINDING_HITS);
  wave.states.bind_storage(BINDING_SAMPLE_STATES);
  wave.rays.bind_storage(BINDING_RAYS);
  rays_.bind_storage(BINDING_ARRIVING);
  variant.sample_count = count;
  variant.surface = surface;
  variant.goes_on = surface < kMostSurfaces ? 1 : 0;
  variant.program->dispatch(count);
  return onward_.value();
}

}  // namespace lightwell
