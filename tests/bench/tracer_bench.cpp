// The Embree tracer at the seam against a bare loop of rtcIntersect1 over the same rays, by the same threads.
// Usage: tracer_bench [--json] [--check]. With --check the exit code is 1 if the seam is below 80 % anywhere.
#include <embree3/rtcore.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <iostream>

#include "renderer/gl/device.h"
#include "renderer/tracing/embree/embree_tracer.h"
#include "renderer/tracing/thread_pool.h"
#include "tests/bench/report.h"
#include "tests/gl/trace_scenes.h"

namespace lightwell::bench {
namespace {

constexpr int kRuns = 7;
constexpr double kLeastShare = 0.8;

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Embree as one would first write it: one static scene, default instruction set, one ray at a time.
class BareLoop {
 public:
  BareLoop(const Primitive& primitive, bool robust) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                        primitive.positions.size()),
                primitive.positions.data(), primitive.positions.size() * sizeof(glm::vec3));
    std::memcpy(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, primitive.indices.size() / 3),
        primitive.indices.data(), primitive.indices.size() * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~BareLoop() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareLoop(const BareLoop&) = delete;
  BareLoop& operator=(const BareLoop&) = delete;

  void trace(ThreadPool& pool, const std::vector<Ray>& rays, std::vector<Hit>& hits) const {
    pool.parallel_for(static_cast<std::uint32_t>(rays.size()), 1024, [&](std::uint32_t begin, std::uint32_t end) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      for (std::uint32_t i = begin; i < end; ++i) {
        const Ray& ray = rays[i];
        RTCRayHit query;
        query.ray = {ray.origin_ws.x,
                     ray.origin_ws.y,
                     ray.origin_ws.z,
                     ray.t_min,
                     ray.direction_ws.x,
                     ray.direction_ws.y,
                     ray.direction_ws.z,
                     0.0f,
                     ray.t_max,
                     ~0u,
                     0,
                     0};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        const bool missed = query.hit.geomID == RTC_INVALID_GEOMETRY_ID;
        hits[i] = {missed ? kMiss : query.ray.tfar, 0, query.hit.primID, query.hit.u, query.hit.v};
      }
    });
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

struct Seam {
  Seam(Tracer& tracer, const std::vector<Ray>& rays)
      : tracer_(tracer),
        count_(static_cast<std::uint32_t>(rays.size())),
        rays_("rays", rays.size() * sizeof(Ray), gl::BufferUse::kHostVisible),
        hits_("hits", rays.size() * sizeof(Hit), gl::BufferUse::kHostVisible),
        visible_("visible", rays.size() / 8 + 4, gl::BufferUse::kHostVisible) {
    rays_.upload(std::span<const Ray>(rays));
  }
  void closest_hit() { tracer_.closest_hit(rays_, count_, hits_); }
  void any_hit() { tracer_.any_hit(rays_, count_, visible_); }

  Tracer& tracer_;
  std::uint32_t count_;
  gl::Buffer rays_, hits_, visible_;
};

// Alternating runs, so that a neighbour's load falls on all alike. The share is the median of each run's own.
Row compare(const std::string& scene, const std::string& kind, Seam& seam, const BareLoop& bare,
            const BareLoop& bare_fast, ThreadPool& pool, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  std::vector<double> seam_s, any_s, bare_s, fast_s, shares;
  for (int run = 0; run <= kRuns; ++run) {
    const double a = seconds([&] { seam.closest_hit(); });
    const double b = seconds([&] { bare.trace(pool, rays, hits); });
    const double c = seconds([&] { bare_fast.trace(pool, rays, hits); });
    const double d = seconds([&] { seam.any_hit(); });
    if (run == 0) continue;  // warms the caches
    seam_s.push_back(a), bare_s.push_back(b), fast_s.push_back(c), any_s.push_back(d), shares.push_back(b / a);
  }
  const double millions = static_cast<double>(rays.size()) / 1e6;
  return {{{"scene", scene}, {"rays", kind}},
          {{"seam Mray/s", millions / median(seam_s)},
           {"bare Mray/s", millions / median(bare_s)},
           {"seam/bare", median(shares)},
           {"bare, not watertight Mray/s", millions / median(fast_s)},
           {"seam any hit Mray/s", millions / median(any_s)}}};
}

void measure_rates(Report& report, ThreadPool& pool) {
  const std::pair<const char*, std::uint32_t> scenes[] = {{"3k", 39}, {"70k", 187}, {"600k", 548}};
  for (const auto& [name, side] : scenes) {
    test::TraceWorld world;
    world.add(test::bumpy_shell(side));
    const auto tracer = make_embree_tracer();
    const double build_s = seconds([&] { tracer->update(world.scene()); });
    const Primitive& primitive = *world.instances[0].primitive;
    const BareLoop bare(primitive, true), bare_fast(primitive, false);

    const std::vector<Ray> camera = test::camera_rays({0.0f, 0.0f, 1.0f}, 768);
    std::vector<Hit> hits(camera.size());
    bare.trace(pool, camera, hits);
    std::vector<Ray> first;
    std::vector<Hit> first_hits;
    for (std::size_t i = 0; i < camera.size(); i += 32) first.push_back(camera[i]), first_hits.push_back(hits[i]);
    const std::vector<Ray> diffuse = test::diffuse_rays(world, first, first_hits, 32, 1);

    Seam camera_seam(*tracer, camera), diffuse_seam(*tracer, diffuse);
    auto& rows = report.section("closest hit");
    rows.push_back(compare(name, "primary", camera_seam, bare, bare_fast, pool, camera));
    rows.push_back(compare(name, "diffuse", diffuse_seam, bare, bare_fast, pool, diffuse));
    report.section("hierarchies")
        .push_back({{{"scene", name}},
                    {{"build ms", build_s * 1e3}, {"MiB", static_cast<double>(tracer->memory_bytes()) / (1 << 20)}}});
  }
}

void measure_update(Report& report) {
  for (const int instances : {20, 200, 2000}) {
    test::TraceWorld world;
    const auto mesh = test::bumpy_shell(6);
    for (int i = 0; i < instances; ++i) world.add(mesh);
    const auto tracer = make_embree_tracer();
    std::vector<double> moving_s, still_s;
    for (int frame = 0; frame < 60; ++frame) {
      for (int i = 0; i < instances; ++i)
        world.instances[static_cast<std::size_t>(i)].world_from_object = glm::translate(
            glm::mat4(1.0f),
            {3.0f * static_cast<float>(i % 45), 0.1f * static_cast<float>(frame), 3.0f * static_cast<float>(i / 45)});
      moving_s.push_back(seconds([&] { tracer->update(world.scene()); }));
      still_s.push_back(seconds([&] { tracer->update(world.scene()); }));
    }
    report.section("update per frame")
        .push_back({{{"instances", std::to_string(instances)}},
                    {{"all moving ms", median(moving_s) * 1e3}, {"none moving ms", median(still_s) * 1e3}}});
  }
}

int run(bool json, bool check) {
  const auto context = gl::Context::create();
  ThreadPool pool;
  Report report;
  report.machine = {{"device", context->device().gl_renderer},
                    {"threads", std::to_string(pool.thread_count())},
                    {"runs", std::to_string(kRuns) + ", medians"}};
  measure_rates(report, pool);
  measure_update(report);
  json ? print_json(report, std::cout) : print_table(report, std::cout);
  bool good = true;
  for (const Row& row : report.section("closest hit"))
    for (const auto& [name, value] : row.figures) good &= name != "seam/bare" || value >= kLeastShare;
  return check && !good ? 1 : 0;
}

}  // namespace
}  // namespace lightwell::bench

int main(int count, char** arguments) {
  bool json = false, check = false;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--json")
      json = true;
    else if (argument == "--check")
      check = true;
    else {
      std::cerr << "usage: tracer_bench [--json] [--check]\n";
      return 2;
    }
  }
  return lightwell::bench::run(json, check);
}
