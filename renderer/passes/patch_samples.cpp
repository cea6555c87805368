#include "renderer/passes/patch_samples.h"
#include "renderer/passes/clear_shadows.h"

#include <algorithm>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr GLbitfield kBetweenStages = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;
constexpr std::uint32_t kNoPhase = ~0u;
constexpr float kGreatestLight = 1e9f;  // nit; what the environment may have at most. More overflows the cells' sums
constexpr std::uint32_t kSamplesPerWalker = 8;
constexpr std::uint32_t kNoPathWord = ~0u;  // fills a ray that is none, for it compares with nothing, and names no cell

gl::Defines light_defines(const LightTable& lights) {
  gl::Defines defines;
  if (lights.has_punctual()) defines.emplace_back("LIGHTS_PUNCTUAL 1");
  if (lights.has_emitters()) defines.emplace_back("LIGHTS_TRIANGLES 1");
  if (lights.has_environment()) defines.emplace_back("LIGHTS_ENVIRONMENT 1");
  return defines;
}

// Rays and what they hit.
struct Wave {
  explicit Wave(gl::BufferUse use)
      : rays("sample rays", 0, use),
        shadow_rays("sample shadow rays", 0, use),
        hits("sample hits", 0, use),
        visible("visible lights", 0, use),
        states("sample states", 0),
        light("light of samples", 0) {}
  void resize(std::uint64_t paths, std::uint64_t shadow_paths, std::uint64_t state_words) {
    rays.reserve(paths * sizeof(Ray));
    shadow_rays.reserve(shadow_paths * sizeof(Ray));
    hits.reserve((paths + 2) * sizeof(Hit));  // read four words at a time
    visible.reserve((shadow_paths + 31) / 32 * sizeof(std::uint32_t));
    states.reserve(paths * state_words * sizeof(glm::vec4));
    light.reserve((paths + shadow_paths) * sizeof(glm::vec4));
    ray_texels.attach(rays);
    hit_texels.attach(hits);
  }
  gl::Buffer rays, shadow_rays, hits, visible, states, light;
  gl::BufferTexture ray_texels{"sample rays", GL_RGBA32F}, hit_texels{"sample hits", GL_RGBA32UI};
};

}  // namespace

// From the pixels' surfaces; from the hits, of which there are those of this and of the next frame. These begin with
// the walkers: paths that go on from frame to frame.
struct PatchSamplesPass::Slots {
  explicit Slots(gl::BufferUse use)
      : first(use), next(std::make_unique<Wave>(use)), later(std::make_unique<Wave>(use)) {}
  Wave first;
  std::unique_ptr<Wave> next, later;
  std::uint32_t walkers = 0;
};

// What rays have come to, and where some of their paths go on.
struct PatchSamplesPass::Meeting {
  bool first;  // along the rays from the pixels
  const Wave& wave;
  const gl::Buffer& states;
  std::uint32_t paths;
  const Wave& onward;
  std::uint32_t stride, phase, first_onward, most_onward;
};

struct PatchSamplesPass::HitProgram {
  explicit HitProgram(const gl::ProgramPtr& p)
      : program(p),
        grid(p),
        lights(p),
        cache(p),
        path_count(p, "path_count"),
        path_stride(p, "path_stride"),
        path_phase(p, "path_phase"),
        first_next(p, "first_next"),
        most_next(p, "most_next"),
        lamps_light_hits(p, "lamps_light_hits"),
        cache_lights_hits(p, "cache_lights_hits") {}
  gl::ProgramPtr program;
  PatchGridUniforms grid;
  LightTableUniforms lights;
  RadianceCacheUniforms cache;
  gl::Uniform<std::uint32_t> path_count, path_stride, path_phase, first_next, most_next;
  gl::Uniform<int> lamps_light_hits, cache_lights_hits;
};

struct PatchSamplesPass::Programs {
  struct SurfaceProgram {
    explicit SurfaceProgram(const gl::ProgramPtr& p)
        : program(p), grid(p), lights(p), sample_count(p, "sample_count") {}
    gl::ProgramPtr program;
    PatchGridUniforms grid;
    LightTableUniforms lights;
    gl::Uniform<std::uint32_t> sample_count;
  };
  Programs(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
      : surfaces([&shaders](const gl::Defines& d) { return shaders.compute("passes/surface_samples.comp", d); }),
        hits([&shaders](const gl::Defines& d) { return shaders.compute("passes/sample_hits.comp", d); }),
        clear_shadows(shaders, buffers) {}
  gl::Variants<SurfaceProgram> surfaces;
  gl::Variants<HitProgram> hits;
  ClearShadowsPass clear_shadows;
};

PatchSamplesPass::PatchSamplesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : programs_(std::make_unique<Programs>(shaders, buffers)), slots_(std::make_unique<Slots>(buffers)) {}

PatchSamplesPass::~PatchSamplesPass() = default;

void PatchSamplesPass::resize(const PatchGrid& grid) {
  const std::uint64_t paths = grid.samples();
  Slots& s = *slots_;
  s.first.resize(paths, paths + grid.texels(), 1);
  if (s.walkers != grid.samples() / kSamplesPerWalker) {
    s.walkers = grid.samples() / kSamplesPerWalker;
    for (Wave* wave : {s.next.get(), s.later.get()}) {
      wave->resize(paths + s.walkers, paths + s.walkers, 2);
      wave->rays.clear(kNoPathWord);
      wave->states.clear(kNoPathWord);
    }
  }
  samples_.states.attach(s.first.states);
  samples_.light.attach(s.first.light);
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
  samples_.path_phase = paths_go_on ? grid.frame_number % path_stride : kNoPhase;
  samples_.first_next = s.walkers;
  samples_.lamps_sampled = lights.has_sized();
  sample_surfaces(frame, g_buffer, lights, grid);
  frame.timer.mark("directions");
  frame.tracer.closest_hit(s.first.rays, grid.samples(), s.first.hits);
  frame.rays += grid.samples();
  frame.timer.mark("trace");
  meet_hits(frame, lights, cache, grid,
            {true, s.first, s.first.states, grid.samples(), *s.next, path_stride, samples_.path_phase, s.walkers,
             grid.samples()});
  frame.timer.mark("light of hits");
  const std::uint32_t shadow_rays = grid.samples() + (samples_.lamps_sampled ? grid.texels() : 0);
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
  gl::Defines defines = frame.scene.brdf_defines();
  if (samples_.lamps_sampled) {
    defines = gl::joined(gl::joined(defines, frame.scene.texture_defines()), frame.scene.environment_defines());
    defines.emplace_back("HAS_SIZED_LIGHTS 1");
    if (lights.has_emitters()) defines.emplace_back("LIGHTS_TRIANGLES 1");
    if (lights.has_environment()) defines.emplace_back("LIGHTS_ENVIRONMENT 1");
  }
  auto& variant = programs_->surfaces.with(defines);
  variant.grid.set(grid);
  variant.lights.set(lights.counts());
  variant.sample_count = grid.samples();
  g_buffer.bind();
  const Wave& wave = slots_->first;
  wave.rays.bind_storage(BINDING_SAMPLE_RAYS);
  wave.shadow_rays.bind_storage(BINDING_SAMPLE_SHADOW_RAYS);
  wave.states.bind_storage(BINDING_SAMPLE_STATES);
  wave.light.bind_storage(BINDING_SAMPLE_LIGHT);
  variant.program->dispatch(grid.samples());
  glMemoryBarrier(kBetweenStages);
}

void PatchSamplesPass::meet_hits(const FrameContext& frame, const LightTable& lights, const RadianceCache& cache,
                                 const PatchGrid& grid, const Meeting& meeting) {
  gl::Defines defines = gl::joined(gl::joined(frame.scene.texture_defines(), frame.scene.brdf_defines()),
                                   gl::joined(frame.scene.environment_defines(), light_defines(lights)));
  if (meeting.first) defines.emplace_back("FIRST_HITS 1");
  HitProgram& variant = programs_->hits.with(defines);
  variant.grid.set(grid);
  variant.lights.set(lights.counts());
  variant.path_count = meeting.paths;
  variant.path_stride = meeting.stride;
  variant.path_phase = meeting.phase;
  variant.first_next = meeting.first_onward;
  variant.most_next = meeting.most_onward;
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
  glMemoryBarrier(kBetweenStages);
}

// What came along the rays from hits fills the cache, and lights the hits whose cells are new.
void PatchSamplesPass::follow_paths(FrameContext& frame, const LightTable& lights, RadianceCache& cache,
                                    const PatchGrid& grid) {
  Slots& s = *slots_;
  Wave& wave = *s.next;
  const std::uint32_t paths =
      s.walkers + (grid.samples() - samples_.path_phase + samples_.path_stride - 1) / samples_.path_stride;
  frame.tracer.closest_hit(wave.rays, paths, wave.hits);
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
