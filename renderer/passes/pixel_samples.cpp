#include "renderer/passes/pixel_samples.h"

#include <utility>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr std::uint32_t kRaysOfUnmatched = 4;  // each

constexpr std::uint32_t kNoFrame = 0x7fffffffu;

gl::Defines defines_of(PixelSamplesPass::Kind kind) {
  switch (kind) {
    case PixelSamplesPass::Kind::kReflections:
      return {"PIXEL_LIST 1", "REFLECTIONS 1"};
    case PixelSamplesPass::Kind::kClearSurfaces:
      return {"PIXEL_LIST 1", "REFLECTIONS 1", "WHOLE_BRDF 1"};
    default:
      return {"PIXEL_LIST 1"};
  }
}

const char* stage_of(PixelSamplesPass::Kind kind) {
  switch (kind) {
    case PixelSamplesPass::Kind::kReflections:
      return "reflections";
    case PixelSamplesPass::Kind::kClearSurfaces:
      return "clear surfaces";
    default:
      return "unmatched pixels";
  }
}

}  // namespace

PixelSamplesPass::Light::Light(const gl::ProgramPtr& p)
    : program(p),
      sums(p),
      pixel_count(p, "pixel_count"),
      share(p, "share"),
      kept_frames(p, "kept_frames"),
      all_rests(p, "all_rests"),
      previous_clip_from_world(p, "previous_clip_from_world") {}

PixelSamplesPass::PixelSamplesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers, Kind kind)
    : kind_(kind),
      defines_(defines_of(kind)),
      surfaces_([&shaders](const gl::Defines& d) { return shaders.compute("passes/surface_samples.comp", d); }),
      hits_([&shaders](const gl::Defines& d) { return shaders.compute("passes/sample_hits.comp", d); }),
      light_([&shaders](const gl::Defines& d) { return shaders.compute("passes/pixel_light.comp", d); }),
      clear_shadows_(shaders, buffers),
      clear_samples_(shaders, buffers),
      smooth_paths_(shaders, buffers),
      wave_(buffers),
      reflections_("reflections", 0),
      reflections_before_("reflections before", 0) {}

void PixelSamplesPass::run(FrameContext& frame, const Picture& picture, const gl::Buffer& list, std::uint32_t count,
                           const PixelSampling& sampling) {
  if (count == 0) return;
  PatchGrid grid;
  grid.map_size_px = {static_cast<int>(count), 1};
  grid.picture_size_px = frame.size_px;
  grid.rays_per_texel = kind_ == Kind::kUnmatched ? kRaysOfUnmatched : refracts(frame.scene) ? 2 : 1;
  grid.frame_number = sampling.frame_number;
  grid.seed = frame.settings.seed;
  wave_.resize(grid.samples(), grid.samples() + grid.traced_texels(), 1, sampling.firefly_clamp != nullptr);
  list_texels_.attach(list);
  list_texels_.bind(UNIT_PIXEL_LIST);
  sample_surfaces(frame, sampling, grid);
  frame.tracer.closest_hit(wave_.rays, grid.samples(), wave_.hits);
  if (kind_ != Kind::kUnmatched)
    smooth_paths_.run(frame, SmoothPathsPass::Kind::kImages, wave_, grid.samples(), grid.traced_texels(),
                      grid.frame_number);
  clear_samples_.run(frame, wave_, grid.samples(), grid.frame_number);
  meet_hits(frame, sampling, grid);
  const std::uint32_t shadow_rays = grid.samples() + (sampling.lights.has_sized() ? grid.traced_texels() : 0);
  clear_shadows_.run(frame, wave_.shadow_rays, shadow_rays, wave_.visible,
                     {wave_.light, 1, 2, grid.samples(), 2 * grid.samples()}, false);
  frame.rays += grid.samples() + shadow_rays;
  if (sampling.firefly_clamp) clamp_fireflies(frame, sampling, grid);
  add_light(frame, picture, sampling, grid);
  frame.timer.mark(stage_of(kind_));
}

gl::Defines PixelSamplesPass::defines(const DeviceScene& scene) const {
  return refracts(scene) ? gl::joined(defines_, {"REFRACTED 1"}) : defines_;
}

void PixelSamplesPass::sample_surfaces(const FrameContext& frame, const PixelSampling& sampling,
                                       const PatchGrid& grid) {
  gl::Defines defines =
      gl::joined(gl::joined(frame.scene.brdf_defines(), frame.scene.smooth_defines()), this->defines(frame.scene));
  if (sampling.lights.has_sized()) {
    defines = gl::joined(gl::joined(defines, frame.scene.texture_defines()), frame.scene.environment_defines());
    defines.emplace_back("HAS_SIZED_LIGHTS 1");
    defines = gl::joined(defines, sampling.lights.sized_defines());
  }
  SurfaceSamplesProgram& variant = surfaces_.with(defines);
  variant.grid.set(grid);
  variant.lights.set(sampling.lights.counts());
  variant.sample_count = grid.samples();
  sampling.g_buffer.bind();
  wave_.rays.bind_storage(BINDING_SAMPLE_RAYS);
  wave_.shadow_rays.bind_storage(BINDING_SAMPLE_SHADOW_RAYS);
  wave_.states.bind_storage(BINDING_SAMPLE_STATES);
  wave_.light.bind_storage(BINDING_SAMPLE_LIGHT);
  variant.program->dispatch(grid.samples());
  glMemoryBarrier(kBetweenSampleStages);
}

// No path goes on: the cache has what comes from beyond the hits.
void PixelSamplesPass::meet_hits(const FrameContext& frame, const PixelSampling& sampling, const PatchGrid& grid) {
  gl::Defines defines = gl::joined(gl::joined(frame.scene.texture_defines(), frame.scene.brdf_defines()),
                                   gl::joined(frame.scene.environment_defines(), sampling.lights.defines()));
  defines = gl::joined(gl::joined(defines, this->defines(frame.scene)), ClearSamplesPass::defines(frame.scene));
  defines.emplace_back("FIRST_HITS 1");
  if (sampling.firefly_clamp) defines.emplace_back("FIREFLY_CLAMP 1");
  if (kind_ != Kind::kUnmatched)
    defines = gl::joined(defines, SmoothPathsPass::defines(frame.scene, SmoothPathsPass::Kind::kImages));
  SampleHitsProgram& variant = hits_.with(defines);
  variant.grid.set(grid);
  variant.lights.set(sampling.lights.counts());
  variant.path_count = grid.samples();
  variant.path_stride = 1;
  variant.path_phase = 1;
  variant.first_direct = first_direct(grid);
  const int beyond = frame.settings.bounces > 1 ? 1 : 0;
  variant.most_bounces = static_cast<std::uint32_t>(frame.settings.bounces);
  variant.lamps_light_hits = beyond;
  variant.cache_lights_hits = beyond;
  sampling.cache.bind_for_lookups(variant.cache);
  wave_.ray_texels.bind(UNIT_RAYS);
  wave_.hit_texels.bind(UNIT_HITS);
  state_texels_.attach(wave_.states);
  state_texels_.bind(UNIT_SAMPLE_STATES);
  wave_.shadow_rays.bind_storage(BINDING_SAMPLE_SHADOW_RAYS);
  wave_.light.bind_storage(BINDING_SAMPLE_LIGHT);
  variant.program->dispatch(grid.samples());
  glMemoryBarrier(kBetweenSampleStages);
}

void PixelSamplesPass::clamp_fireflies(const FrameContext& frame, const PixelSampling& sampling,
                                       const PatchGrid& grid) {
  light_texels_.attach(wave_.light);
  visible_texels_.attach(wave_.visible);
  state_texels_.bind(UNIT_SAMPLE_STATES);
  light_texels_.bind(UNIT_SAMPLE_LIGHT);
  visible_texels_.bind(UNIT_SAMPLE_VISIBLE);
  sampling.g_buffer.bind();
  sampling.firefly_clamp->run_over_pixels(frame, wave_.light, grid, sampling.lights.has_sized(), defines(frame.scene));
}

void PixelSamplesPass::add_light(const FrameContext& frame, const Picture& picture, const PixelSampling& sampling,
                                 const PatchGrid& grid) {
  gl::Defines defines =
      gl::joined(gl::joined(frame.scene.brdf_defines(), frame.scene.smooth_defines()), this->defines(frame.scene));
  defines.emplace_back("JOINT_UPSCALE 1");
  if (kind_ != Kind::kUnmatched) {
    if (sampling.g_buffer.has_motion) defines.emplace_back("MOTION 1");
    std::swap(reflections_, reflections_before_);
    const std::uint64_t bytes = 2 * sizeof(glm::uvec4) * static_cast<std::uint64_t>(frame.size_px.x) *
                                static_cast<std::uint64_t>(frame.size_px.y);
    for (gl::Buffer* buffer : {&reflections_, &reflections_before_})
      if (buffer->reserve(bytes)) buffer->clear(kNoFrame);
    before_texels_.attach(reflections_before_);
    before_texels_.bind(UNIT_REFLECTIONS_BEFORE);
    reflections_.bind_storage(BINDING_REFLECTIONS);
  }
  Light& variant = light_.with(defines);
  variant.sums.set(grid, sampling.lights.has_sized());
  variant.pixel_count = grid.traced_texels();
  variant.share = 1.0f / static_cast<float>(picture.accumulated);
  variant.kept_frames = sampling.kept_frames;
  variant.all_rests = sampling.all_rests ? 1.0f : 0.0f;
  variant.previous_clip_from_world = sampling.previous_clip_from_world;
  sampling.g_buffer.bind();
  light_texels_.attach(wave_.light);
  visible_texels_.attach(wave_.visible);
  state_texels_.bind(UNIT_SAMPLE_STATES);
  light_texels_.bind(UNIT_SAMPLE_LIGHT);
  visible_texels_.bind(UNIT_SAMPLE_VISIBLE);
  if (kind_ == Kind::kUnmatched) {
    sampling.map.image->bind(UNIT_IMAGE_B);
    sampling.map.guide->bind(UNIT_GUIDE);
  }
  picture.image.bind_image(0, GL_READ_WRITE);
  variant.program->dispatch(grid.traced_texels());
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace lightwell
