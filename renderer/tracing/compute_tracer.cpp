// The tracers that never leave the device: trace.comp over hierarchies built on the CPU, or over all triangles.
#include <optional>

#include "renderer/check.h"
#include "renderer/gl/program.h"
#include "renderer/tracing/bindings.glsl"
#include "renderer/tracing/device_hierarchies.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {
namespace {

// Empties the list.
void bind_list(HitList& list) {
  constexpr std::uint32_t kNone[4] = {0, 1, 1, 0};
  list.dispatch.upload(std::span<const std::uint32_t>(kNone));
  list.rays.bind_storage(TRACE_BINDING_HIT_LIST);
  list.dispatch.bind_storage(TRACE_BINDING_HIT_DISPATCH);
}

void finish_writing() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT |
                  GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

// What a tracer does for all its rays.
struct Way {
  bool brute_force = false;
  const gl::Buffer* tests = nullptr;  // where it counts them
};

std::vector<std::string> defines_of(bool any_hit, bool coverage, const Way& way) {
  return {any_hit ? "ANY_HIT 1" : "ANY_HIT 0", coverage ? "COVERAGE 1" : "COVERAGE 0",
          way.brute_force ? "BRUTE_FORCE 1" : "BRUTE_FORCE 0", way.tests ? "COUNT_TESTS 1" : "COUNT_TESTS 0"};
}

// One build of trace.comp.
class TraceProgram {
 public:
  TraceProgram(gl::ShaderLibrary& shaders, bool any_hit, bool coverage, const Way& way)
      : program_(shaders.compute("tracing/trace.comp", defines_of(any_hit, coverage, way))),
        lists_hits_(program_, "lists_hits"),
        ray_count_(program_, "ray_count"),
        top_root_(program_, "top_root"),
        scene_groups_(program_, "scene_groups") {}

  void run(const gl::Buffer& rays, std::uint32_t count, const gl::Buffer& results, const DeviceHierarchies& hierarchies,
           HitList* list = nullptr) const {
    hierarchies.bind();
    lists_hits_ = list ? 1 : 0;
    if (list) bind_list(*list);
    rays.bind_storage(TRACE_BINDING_RAYS);
    results.bind_storage(TRACE_BINDING_RESULTS);
    ray_count_ = count;
    top_root_ = hierarchies.top_root();
    scene_groups_ = hierarchies.group_count();
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    program_->dispatch(count, TRACE_GROUP_SIZE);
    finish_writing();
  }

 private:
  gl::ProgramPtr program_;
  gl::Uniform<int> lists_hits_;
  gl::Uniform<std::uint32_t> ray_count_, top_root_, scene_groups_;
};

// One build of candidates.comp.
class CandidateProgram {
 public:
  CandidateProgram(gl::ShaderLibrary& shaders, bool coverage, const Way& way)
      : program_(shaders.compute("tracing/candidates.comp", defines_of(false, coverage, way))),
        pixel_count_(program_, "pixel_count"),
        patch_count_(program_, "patch_count"),
        direction_count_(program_, "direction_count"),
        group_count_(program_, "group_count"),
        top_root_(program_, "top_root"),
        scene_groups_(program_, "scene_groups"),
        trace_missed_(program_, "trace_missed") {}

  void run(const CandidateTest& test, const gl::Buffer& hits, const DeviceHierarchies& hierarchies,
           HitList& list) const {
    hierarchies.bind();
    hierarchies.bind_places();
    bind_list(list);
    test.candidates.bind_storage(TRACE_BINDING_RAYS);
    hits.bind_storage(TRACE_BINDING_RESULTS);
    test.pixels.bind_storage(TRACE_BINDING_PIXELS);
    test.directions.bind_storage(TRACE_BINDING_DIRECTIONS);
    pixel_count_ = test.pixel_count;
    patch_count_ = test.patch_count;
    direction_count_ = test.direction_count;
    group_count_ = test.group_count;
    top_root_ = hierarchies.top_root();
    scene_groups_ = hierarchies.group_count();
    trace_missed_ = test.trace_missed ? 1 : 0;
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    program_->dispatch(test.pixel_count * test.direction_count, TRACE_GROUP_SIZE);
    finish_writing();
  }

 private:
  gl::ProgramPtr program_;
  gl::Uniform<std::uint32_t> pixel_count_, patch_count_, direction_count_, group_count_, top_root_, scene_groups_;
  gl::Uniform<int> trace_missed_;
};

class ComputeTracer final : public Tracer {
 public:
  explicit ComputeTracer(const Way& way) : way_(way) {}

  std::string_view name() const override { return way_.brute_force ? "brute-force" : "compute"; }

  void update(const TraceScene& scene) override { hierarchies_.update(scene); }

  void closest_hit(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits, HitList* list) override {
    LIGHTWELL_CHECK_OP(std::uint64_t{count} * sizeof(Ray), <=, rays.size_bytes());
    LIGHTWELL_CHECK_OP(std::uint64_t{count} * sizeof(Hit), <=, hits.size_bytes());
    bind_tests();
    (hierarchies_.needs_coverage() ? covered_closest_hit_ : closest_hit_).run(rays, count, hits, hierarchies_, list);
  }

  void any_hit(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& visible) override {
    LIGHTWELL_CHECK_OP(std::uint64_t{count} * sizeof(Ray), <=, rays.size_bytes());
    LIGHTWELL_CHECK_OP((std::uint64_t{count} + 31) / 32 * sizeof(std::uint32_t), <=, visible.size_bytes());
    bind_tests();
    (hierarchies_.needs_coverage() ? covered_any_hit_ : any_hit_).run(rays, count, visible, hierarchies_);
  }

  void test_candidates(const CandidateTest& test, gl::Buffer& hits, HitList& list) override {
    LIGHTWELL_CHECK_OP(std::uint64_t{test.pixel_count} * test.direction_count * sizeof(Hit), <=, hits.size_bytes());
    std::optional<CandidateProgram>& program = hierarchies_.needs_coverage() ? covered_candidates_ : candidates_;
    if (!program) program.emplace(shaders_, hierarchies_.needs_coverage(), way_);
    bind_tests();
    program->run(test, hits, hierarchies_, list);
  }

  std::uint64_t memory_bytes() const override { return hierarchies_.memory_bytes(); }

 private:
  // Where the programs find it.
  void bind_tests() const {
    if (way_.tests) way_.tests->bind_storage(TRACE_BINDING_TESTS);
  }

  Way way_;
  gl::ShaderLibrary shaders_;
  TraceProgram closest_hit_{shaders_, false, false, way_};
  TraceProgram covered_closest_hit_{shaders_, false, true, way_};
  TraceProgram any_hit_{shaders_, true, false, way_}, covered_any_hit_{shaders_, true, true, way_};
  std::optional<CandidateProgram> candidates_, covered_candidates_;  // made when patches are first used
  DeviceHierarchies hierarchies_{shaders_};
};

}  // namespace

std::unique_ptr<Tracer> make_compute_tracer() {
  return std::make_unique<ComputeTracer>(Way{});
}

std::unique_ptr<Tracer> make_counting_tracer(bool brute_force, const gl::Buffer& tests) {
  return std::make_unique<ComputeTracer>(Way{brute_force, &tests});
}

std::unique_ptr<Tracer> make_brute_force_tracer() {
  return std::make_unique<ComputeTracer>(Way{true});
}

}  // namespace lightwell
