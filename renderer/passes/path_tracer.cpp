#include "renderer/passes/path_tracer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

// Paths in flight. A software device keeps what they carry in its caches; a GPU must have many to hide its latencies.
constexpr std::uint32_t kPathsOnHost = 1u << 16;
constexpr std::uint32_t kPathsOnDevice = 1u << 19;  // as many as a path's word can name

constexpr GLbitfield kBetweenStages = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;

// Uniforms of shaders/path.glsl, where a program has them.
struct PathUniforms {
  explicit PathUniforms(const gl::ProgramPtr& p)
      : path_count(p, "path_count"),
        first_pixel(p, "first_pixel"),
        picture_width_px(p, "picture_width_px"),
        sample_number(p, "sample_number"),
        seed(p, "seed"),
        shown(p, "shown") {}

  void set(const FrameContext& frame, std::uint32_t first) const {
    first_pixel = first;
    picture_width_px = frame.size_px.x;
    sample_number = frame.frame_number;
    seed = frame.settings.seed;
    const ViewKind view = frame.settings.view;
    shown = glm::vec2(view == ViewKind::kIndirect ? 0.0f : 1.0f, view == ViewKind::kDirect ? 0.0f : 1.0f);
  }

  gl::Uniform<std::uint32_t> path_count, first_pixel;
  gl::Uniform<int> picture_width_px;
  gl::Uniform<std::uint32_t> sample_number, seed;
  gl::Uniform<glm::vec2> shown;
};

struct PathProgram {
  explicit PathProgram(gl::ProgramPtr p) : program(std::move(p)), uniforms(program) {}
  gl::ProgramPtr program;
  PathUniforms uniforms;
};

// What paths carry from one surface to the next.
struct Carried {
  Carried(gl::BufferUse use, std::uint32_t paths)
      : rays("path rays", std::uint64_t{paths} * sizeof(Ray), use),
        states("path states", std::uint64_t{paths} * sizeof(glm::vec4)),
        pending("pending light", std::uint64_t{paths} * sizeof(glm::uvec4)),
        ray_texels("path rays", GL_RGBA32F),
        state_texels("path states", GL_RGBA32F),
        pending_texels("pending light", GL_RGBA32UI) {
    ray_texels.attach(rays);
    state_texels.attach(states);
    pending_texels.attach(pending);
  }
  void bind_for_writing() const {
    rays.bind_storage(BINDING_PATH_RAYS);
    states.bind_storage(BINDING_PATH_STATES);
    pending.bind_storage(BINDING_PATH_PENDING);
  }
  void bind_for_reading() const {
    ray_texels.bind(UNIT_RAYS);
    state_texels.bind(UNIT_PATH_STATES);
    pending_texels.bind(UNIT_PATH_PENDING);
  }
  gl::Buffer rays, states, pending;  // in `pending` also the paths' words
  gl::BufferTexture ray_texels, state_texels, pending_texels;
};

}  // namespace

// The programs for one kind of scene.
struct PathTracerPass::SurfaceVariant : PathProgram {
  explicit SurfaceVariant(const gl::ProgramPtr& p)
      : PathProgram(p),
        lights(p),
        most_bounces(p, "most_bounces"),
        strategies(p, "strategies"),
        guide_cell_m(p, "guide_cell_m") {}

  void set(const FrameContext& frame, const LightTable& table, std::uint32_t first) const {
    uniforms.set(frame, first);
    lights.set(table.counts());
    most_bounces = static_cast<std::uint32_t>(frame.settings.bounces);
    const LightStrategy strategy = frame.settings.light_strategy;
    strategies =
        glm::vec2(strategy == LightStrategy::kRays ? 0.0f : 1.0f, strategy == LightStrategy::kLights ? 0.0f : 1.0f);
  }

  LightTableUniforms lights;
  gl::Uniform<std::uint32_t> most_bounces;
  gl::Uniform<glm::vec2> strategies;
  gl::Uniform<float> guide_cell_m;
};

struct PathTracerPass::Programs {
  explicit Programs(gl::ShaderLibrary& shaders)
      : start(shaders.compute("passes/path_start.comp")),
        accumulate(shaders.raster("passes/full_screen.vert", "passes/path_accumulate.frag")),
        vertex([&shaders](const gl::Defines& defines) { return shaders.compute("passes/path_vertex.comp", defines); }),
        end([&shaders](const gl::Defines& defines) { return shaders.compute("passes/path_end.comp", defines); }) {}
  PathProgram start, accumulate;
  gl::Variants<SurfaceVariant> vertex, end;
};

struct PathTracerPass::Slots {
  Slots(gl::BufferUse use, std::uint32_t paths)
      : from(std::make_unique<Carried>(use, paths)),
        to(std::make_unique<Carried>(use, paths)),
        shadow_rays("shadow rays", std::uint64_t{paths} * sizeof(Ray), use),
        hits("path hits", std::uint64_t{paths} * sizeof(Hit), use),
        visible("visible lights", (std::uint64_t{paths} + 31) / 32 * 4, use),
        radiance("path radiance", std::uint64_t{paths} * sizeof(glm::vec4)),
        hit_list(use),
        hit_texels("path hits", GL_RGBA32UI),
        visible_texels("visible lights", GL_R32UI),
        radiance_texels("path radiance", GL_RGBA32F) {
    hit_list.resize(paths);
    hit_texels.attach(hits);
    visible_texels.attach(visible);
    radiance_texels.attach(radiance);
  }

  std::unique_ptr<Carried> from, to;  // what paths brought to their surfaces, and what they take from there
  gl::Buffer shadow_rays, hits, visible, radiance;
  HitList hit_list;
  gl::BufferTexture hit_texels, visible_texels, radiance_texels;
};

PathTracerPass::PathTracerPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : programs_(std::make_unique<Programs>(shaders)),
      clear_shadows_(shaders, buffers),
      guides_(shaders, buffers),
      most_paths_(buffers == gl::BufferUse::kHostVisible ? kPathsOnHost : kPathsOnDevice) {
  slots_ = std::make_unique<Slots>(buffers, most_paths_);
}

PathTracerPass::~PathTracerPass() = default;

void PathTracerPass::resize(glm::ivec2 size_px) {
  if (picture_.image && picture_.image.size_px() == size_px) return;
  picture_ = {gl::Texture("picture", GL_RGBA32F, size_px), 0};
  framebuffer_ = gl::Framebuffer("picture", {&picture_.image}, nullptr);
}

// A software device pays for all that a shader could do, so there is one for each kind of scene. They are compiled when
// the first such scene comes: together they would take seconds.
gl::Defines PathTracerPass::defines_for(const DeviceScene& scene, const LightTable& lights) const {
  gl::Defines defines =
      gl::joined(gl::joined(scene.texture_defines(), scene.brdf_defines()), scene.environment_defines());
  if (scene.is_lambert()) defines.emplace_back("LAMBERT_ONLY 1");
  if (scene.has_clear_walls()) defines.emplace_back("CLEAR_WALLS 1");
  return gl::joined(defines, lights.defines());
}

const Picture& PathTracerPass::run(FrameContext& frame, const Scene& scene, const LightTable& lights) {
  guides_.run(frame, scene, lights, defines_for(frame.scene, lights));
  if (frame.frame_number == 0) picture_.accumulated = 0;
  const auto width = static_cast<std::uint32_t>(frame.size_px.x);
  const int rows_per_wave = std::max(1, static_cast<int>(most_paths_ / width));
  for (int row = 0; row < frame.size_px.y; row += rows_per_wave) {
    const int rows = std::min(rows_per_wave, frame.size_px.y - row);
    trace_wave(frame, lights,
               {row, rows, static_cast<std::uint32_t>(row) * width, static_cast<std::uint32_t>(rows) * width});
  }
  ++picture_.accumulated;
  return picture_;
}

void PathTracerPass::trace_wave(FrameContext& frame, const LightTable& lights, const Wave& wave) {
  const gl::Defines defines = defines_for(frame.scene, lights);
  const gl::Defines guides = guides_.has_guides() ? gl::Defines{"GUIDED 1"} : gl::Defines{};
  const SurfaceVariant& vertex = programs_->vertex.with(gl::joined(defines, guides));
  const SurfaceVariant& end = programs_->end.with(defines);
  vertex.set(frame, lights, wave.first_pixel);
  vertex.guide_cell_m = guides_.cell_m();
  end.set(frame, lights, wave.first_pixel);
  Slots& s = *slots_;
  start(frame, wave);
  frame.tracer.closest_hit(s.to->rays, wave.paths, s.hits, &s.hit_list);
  frame.timer.mark("trace");
  end_rays(end, wave.paths);
  frame.timer.mark("ends");
  for (std::uint32_t paths = count_hits(); paths > 0; paths = count_hits()) {
    frame.rays += paths;
    meet_surfaces(vertex, paths);
    frame.timer.mark("surfaces");
    clear_shadows_.run(frame, s.shadow_rays, paths, s.visible, {s.to->pending}, true);
    frame.timer.mark("shadows");
    frame.tracer.closest_hit(s.to->rays, paths, s.hits, &s.hit_list);
    frame.timer.mark("trace");
    end_rays(end, paths);
    frame.timer.mark("ends");
  }
  accumulate(frame, wave);
  frame.timer.mark("accumulate");
}

void PathTracerPass::start(const FrameContext& frame, const Wave& wave) {
  const PathProgram& program = programs_->start;
  program.uniforms.set(frame, wave.first_pixel);
  program.uniforms.path_count = wave.paths;
  slots_->to->bind_for_writing();
  slots_->radiance.bind_storage(BINDING_PATH_RADIANCE);
  program.program->dispatch(wave.paths);
  glMemoryBarrier(kBetweenStages);
}

void PathTracerPass::meet_surfaces(const SurfaceVariant& vertex, std::uint32_t paths) {
  Slots& s = *slots_;
  std::swap(s.from, s.to);
  s.from->bind_for_reading();
  s.to->bind_for_writing();
  s.hit_texels.bind(UNIT_HITS);
  s.hit_list.texels.bind(UNIT_HIT_LIST);
  s.shadow_rays.bind_storage(BINDING_PATH_SHADOW_RAYS);
  s.radiance_texels.bind(UNIT_PATH_RADIANCE);
  s.radiance.bind_storage(BINDING_PATH_RADIANCE);
  if (guides_.has_guides()) guides_.bind();
  vertex.uniforms.path_count = paths;
  vertex.program->dispatch(paths);
  glMemoryBarrier(kBetweenStages);
}

// Adds the light that got through to where paths are, and that of the environment where they left the scene.
void PathTracerPass::end_rays(const SurfaceVariant& end, std::uint32_t paths) {
  Slots& s = *slots_;
  s.to->bind_for_reading();
  s.hit_texels.bind(UNIT_HITS);
  s.visible_texels.bind(UNIT_PATH_VISIBLE);
  s.radiance_texels.bind(UNIT_PATH_RADIANCE);
  s.radiance.bind_storage(BINDING_PATH_RADIANCE);
  end.uniforms.path_count = paths;
  end.program->dispatch(paths);
  glMemoryBarrier(kBetweenStages);
}

std::uint32_t PathTracerPass::count_hits() const {
  constexpr std::size_t kCountWord = 3;
  std::array<std::uint32_t, 4> dispatch{};
  const gl::Buffer& list = slots_->hit_list.dispatch;
  if (list.host()) {
    std::memcpy(dispatch.data(), list.host(), sizeof dispatch);  // written by the tracer, on this side
  } else {
    list.download(std::as_writable_bytes(std::span(dispatch)));
  }
  return dispatch[kCountWord];
}

void PathTracerPass::accumulate(const FrameContext& frame, const Wave& wave) {
  const PathProgram& program = programs_->accumulate;
  program.uniforms.set(frame, wave.first_pixel);
  slots_->radiance_texels.bind(UNIT_PATH_RADIANCE);
  program.program->use();
  framebuffer_.bind();
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, wave.first_row, frame.size_px.x, wave.rows);
  if (picture_.accumulated > 0) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    glBlendColor(0.0f, 0.0f, 0.0f, 1.0f / static_cast<float>(picture_.accumulated + 1));
  }
  full_screen_.draw_full_screen();
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace lightwell
