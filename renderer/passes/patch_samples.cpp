#include "renderer/passes/patch_samples.h"
#include "renderer/passes/clear_samples.h"
#include "renderer/passes/clear_shadows.h"
#include "renderer/passes/smooth_paths.h"

#include <algorithm>

#include "renderer/passes/bindings.glsl"
#include "renderer/passes/sample_wave.h"

namespace lightwell {

namespace {

constexpr std::uint32_t kNoPhase = ~0u;
constexpr float kGreatestLight = 1e9f;  // nit; what the environment may have at most. More overflows the cells' sums
constexpr std::uint32_t kSamplesPerWalker = 8;
constexpr std::uint32_t kNoPathWord = ~0u;  // fills a ray that is none, for it compares with nothing, and names no cell

}  // namespace

// From the pixels' surfaces; from the hits, of which there are those of this and of the next frame. These begin with
// the walkers: paths that go on from frame to frame.
struct PatchSamplesPass::Slots {
  explicit Slots(gl::BufferUse use)
      : first(use), next(std::make_unique<SampleWave>(use)), later(std::make_unique<SampleWave>(use)) {}
  SampleWave first;
  std::unique_ptr<SampleWave> next, later;
  std::uint32_t walkers = 0;
};

// What rays have come to, and where some of their paths go on.
struct PatchSamplesPass::Meeting {
  bool first;  // along the rays from the pixels
  const SampleWave& wave;
  const gl::Buffer& states;
  std::uint32_t paths;
  const SampleWave& onward;
  std::uint32_t stride, phase, first_onward, most_onward;
};

struct PatchSamplesPass::Programs {
  Programs(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
      : surfaces([&shaders](const gl::Defines& d) { return shaders.compute("passes/surface_samples.comp", d); }),
        hits([&shaders](const gl::Defines& d) { return shaders.compute("passes/sample_hits.comp", d); }),
        clear_shadows(shaders, buffers),
        clear_samples(shaders, buffers),
        smooth_paths(shaders, buffers) {}
  gl::Variants<SurfaceSamplesProgram> surfaces;
  gl::Variants<SampleHitsProgram> hits;
  ClearShadowsPass clear_shadows;
  ClearSamplesPass clear_samples;
  SmoothPathsPass smooth_paths;
};

void PatchSamples::bind() const {
  states.bind(UNIT_SAMPLE_STATES);
  light.bind(UNIT_SAMPLE_LIGHT);
  visible.bind(UNIT_SAMPLE_VISIBLE);
  next_states.bind(UNIT_NEXT_STATES);
  next_light.bind(UNIT_NEXT_LIGHT);
}

PatchSamplesPass::PatchSamplesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : programs_(std::make_unique<Programs>(shaders, buffers)), slots_(std::make_unique<Slots>(buffers)) {}

PatchSamplesPass::~PatchSamplesPass() = default;

void PatchSamplesPass::resize(const PatchGrid& grid, bool tells_direct) {
  const std::uint64_t paths = grid.samples();
  Slots& s = *slots_;
  s.first.resize(paths, paths + grid.traced_texels(), 1, tells_direct);
  if (s.walkers != grid.samples() / kSamplesPerWalker) {
    s.walkers = grid.samples() / kSamplesPerWalker;
    for (SampleWave* wave : {s.next.get(), s.later.get()}) {
      wave->resize(paths + s.walkers, paths + s.walkers, 2);
      wave->rays.clear(kNoPathWord);
      wave->states.clear(kNoPathWord);
    }
  }
  samples_.states.attach(s.first.states);
  samples_.light.attach(s.first.light);
  samples_.light_buffer = &s.first.light;
  samples_.visible.attach(s.first.visible);
}

const PatchSamples& PatchSamplesPass::run(FrameContext& frame, const GBuffer& g_buffer, const LightTable& lights,
                                          RadianceCache& cache, const PatchGrid& grid, std::uint32_t path_stride) {
  const bool paths_go_on = frame.settings.bounces > 1;
  Slots& s = *slots_;
  std::swap(s.next, s.later);
  samples_.next_states.attach(s.next->states);
  samples_.next_light.attach(s.next->light);
  samples_.path_stride = path_stride;
  samples_.path_phase = paths_go_on ? grid.frame_number / grid.frames_of_patch() % path_stride : kNoPhase;
  samples_.first_next = s.walkers;
  samples_.lamps_sampled = lights.has_sized();
  sample_surfaces(frame, g_buffer, lights, grid);
  frame.timer.mark("directions");
  frame.tracer.closest_hit(s.first.rays, grid.samples(), s.first.hits);
  programs_->smooth_paths.run(frame, SmoothPathsPass::Kind::kMirrors, s.first, grid.samples(), grid.samples(),
                              grid.frame_number);
  programs_->clear_samples.run(frame, s.first, grid.samples(), grid.frame_number);
  frame.rays += grid.samples();
  frame.timer.mark("trace");
  meet_hits(frame, lights, cache, grid,
            {true, s.first, s.first.states, grid.samples(), *s.next, path_stride, samples_.path_phase, s.walkers,
             grid.samples()});
  frame.timer.mark("light of hits");
  const std::uint32_t shadow_rays = grid.samples() + (samples_.lamps_sampled ? grid.traced_texels() : 0);
  // Behind two words a slot lies the light of the lamps.
  programs_->clear_shadows.run(frame, s.first.shadow_rays, shadow_rays, s.first.visible,
                               {s.first.light, 1, 2, grid.samples(), 2 * grid.samples()}, false);
  frame.rays += shadow_rays;
  frame.timer.mark("shadows of hits");
  if (paths_go_on) follow_paths(frame, lights, cache, grid);
  return samples_;
}

void PatchSamplesPass::sample_surfaces(const FrameContext& frame, const GBuffer& g_buffer, const LightTable& lights,
                                       const PatchGrid& grid) {
  gl::Defines defines = gl::joined(frame.scene.brdf_defines(), frame.scene.smooth_defines());
  if (samples_.lamps_sampled) {
    defines = gl::joined(gl::joined(defines, frame.scene.texture_defines()), frame.scene.environment_defines());
    defines.emplace_back("HAS_SIZED_LIGHTS 1");
    defines = gl::joined(defines, lights.sized_defines());
  }
  auto& variant = programs_->surfaces.with(defines);
  variant.grid.set(grid);
  variant.lights.set(lights.counts());
  variant.sample_count = grid.samples();
  g_buffer.bind();
  const SampleWave& wave = slots_->first;
  wave.rays.bind_storage(BINDING_SAMPLE_RAYS);
  wave.shadow_rays.bind_storage(BINDING_SAMPLE_SHADOW_RAYS);
  wave.states.bind_storage(BINDING_SAMPLE_STATES);
  wave.light.bind_storage(BINDING_SAMPLE_LIGHT);
  variant.program->dispatch(grid.samples());
  glMemoryBarrier(kBetweenSampleStages);
}

void PatchSamplesPass::meet_hits(const FrameContext& frame, const LightTable& lights, const RadianceCache& cache,
                                 const PatchGrid& grid, const Meeting& meeting) {
  gl::Defines defines = gl::joined(gl::joined(frame.scene.texture_defines(), frame.scene.brdf_defines()),
                                   gl::joined(frame.scene.environment_defines(), lights.defines()));
  defines = gl::joined(defines, ClearSamplesPass::defines(frame.scene));
  if (meeting.first) {
    defines.emplace_back("FIRST_HITS 1");
    defines = gl::joined(defines, SmoothPathsPass::defines(frame.scene, SmoothPathsPass::Kind::kMirrors));
    if (frame.settings.firefly_clamp > 0.0f) defines.emplace_back("FIREFLY_CLAMP 1");
  }
  SampleHitsProgram& variant = programs_->hits.with(defines);
  variant.grid.set(grid);
  variant.lights.set(lights.counts());
  variant.path_count = meeting.paths;
  variant.path_stride = meeting.stride;
  variant.path_phase = meeting.phase;
  variant.first_next = meeting.first_onward;
  variant.first_direct = first_direct(grid);
  variant.most_next = meeting.most_onward;
  variant.most_bounces = static_cast<std::uint32_t>(frame.settings.bounces);
  const int bounce = meeting.first ? 1 : 2;
  variant.lamps_light_hits = frame.settings.bounces > bounce ? 1 : 0;
  variant.cache_lights_hits = frame.settings.bounces > bounce ? 1 : 0;
  cache.bind_for_lookups(variant.cache);
  meeting.wave.ray_texels.bind(UNIT_RAYS);
  meeting.wave.hit_texels.bind(UNIT_HITS);
  (meeting.first ? samples_.states : samples_.next_states).bind(UNIT_SAMPLE_STATES);
  meeting.wave.shadow_rays.bind_storage(BINDING_SAMPLE_SHADOW_RAYS);
  meeting.wave.light.bind_storage(BINDING_SAMPLE_LIGHT);
  meeting.onward.rays.bind_storage(BINDING_SAMPLE_RAYS);
  meeting.onward.states.bind_storage(BINDING_SAMPLE_STATES);
  variant.program->dispatch(meeting.paths);
  glMemoryBarrier(kBetweenSampleStages);
}

// What came along the rays from hits fills the cache, and lights the hits whose cells are new.
void PatchSamplesPass::follow_paths(FrameContext& frame, const LightTable& lights, RadianceCache& cache,
                                    const PatchGrid& grid) {
  Slots& s = *slots_;
  SampleWave& wave = *s.next;
  const std::uint32_t paths =
      s.walkers + (grid.samples() - samples_.path_phase + samples_.path_stride - 1) / samples_.path_stride;
  frame.tracer.closest_hit(wave.rays, paths, wave.hits);
  programs_->clear_samples.run(frame, wave, paths, grid.frame_number);
  frame.timer.mark("trace");
  // Where the cache carries no bounces, nobody asks what the walkers find.
  const std::uint32_t walkers = frame.settings.bounces > 2 ? s.walkers : 0;
  const std::uint32_t stride = std::max(1u, paths / std::max(1u, s.walkers));
  meet_hits(frame, lights, cache, grid,
            {false, wave, wave.states, paths, *s.later, stride, grid.frame_number % stride, 0, walkers});
  frame.timer.mark("light of hits");
  programs_->clear_shadows.run(frame, wave.shadow_rays, paths, wave.visible, {wave.light, 1, 2}, false);
  frame.rays += 2 * paths;
  frame.timer.mark("shadows of hits");
  const gl::BufferTexture visible_texels("visible lights", GL_R32UI);
  visible_texels.attach(wave.visible);
  cache.deposit(paths, samples_.next_states, wave.light, visible_texels, kGreatestLight);
  frame.timer.mark("radiance cache");
}

}  // namespace lightwell
