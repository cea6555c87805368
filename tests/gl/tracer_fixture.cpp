#include "tests/gl/tracer_fixture.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <span>
#include <utility>

#ifdef LIGHTWELL_HAS_EMBREE
#include "renderer/tracing/embree/embree_tracer.h"
#endif

namespace lightwell::test {
namespace {

constexpr double kTieDistance = 1e-4;      // relative: nearer triangles than that cannot be told apart
constexpr float kEdgeBarycentric = 1e-4f;  // a hit nearer to its triangle's edge may as well pass it
constexpr double kMostTies = 1e-3;         // of all rays

constexpr double kMostBruteForceTests = 1e8;  // rays times triangles: seconds
constexpr std::uint32_t kMostVisibilityRays = 100'000;

struct Agreement {
  std::size_t same = 0, ties = 0, edges = 0, rounded = 0, wrong = 0;
  std::size_t first_wrong = 0;
};

bool near_edge(const Hit& hit) {
  return is_hit(hit) && std::min({hit.u, hit.v, 1.0f - hit.u - hit.v}) < kEdgeBarycentric;
}

bool distances_agree(double a, double b) {
  return std::abs(a - b) <= kTieDistance * std::max(std::abs(a), std::abs(b));
}

// Whether a distance is right but for the rounding of coordinates: very short distances to a triangle far from the
// origin, or seen edge-on, can be known no better. Judged by the exact distance of the triangle's plane.
bool is_rounded(const TraceWorld& world, const Ray& ray, const Hit& hit) {
  const PlaneDistance exact = plane_distance(world, ray, hit);
  constexpr double kOperations = 8.0;  // roundings that add up in a transform and an intersection
  const double coordinate_error_m = kOperations * std::numeric_limits<float>::epsilon() * exact.largest_coordinate_m;
  return std::abs(hit.t - exact.distance_m) <= coordinate_error_m / std::max(exact.cosine, 1e-6);
}

Agreement compare(const TraceWorld& world, const std::vector<Ray>& rays, const std::vector<Hit>& a,
                  const std::vector<Hit>& b) {
  Agreement agreement;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool both_miss = !is_hit(a[i]) && !is_hit(b[i]);
    const bool near = is_hit(a[i]) && is_hit(b[i]) && distances_agree(a[i].t, b[i].t);
    const bool same_triangle = a[i].instance == b[i].instance && a[i].triangle == b[i].triangle;
    if (both_miss || (near && same_triangle)) {
      ++agreement.same;
    } else if (near) {
      ++agreement.ties;
    } else if (is_hit(a[i]) && is_hit(b[i]) && same_triangle && is_rounded(world, rays[i], a[i]) &&
               is_rounded(world, rays[i], b[i])) {
      ++agreement.rounded;
    } else if (near_edge(a[i]) || near_edge(b[i])) {
      ++agreement.edges;
    } else {
      if (agreement.wrong++ == 0) agreement.first_wrong = i;
    }
  }
  return agreement;
}

void expect_lists(const HitList& list, const std::vector<Hit>& hits) {
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < hits.size(); ++i)
    if (is_hit(hits[i])) expected.push_back(i);
  std::uint32_t dispatch[4] = {};
  list.dispatch.download(std::as_writable_bytes(std::span(dispatch)));
  const auto hit_count = static_cast<std::uint32_t>(expected.size());
  EXPECT_THAT(dispatch, testing::ElementsAre((hit_count + kHitGroup - 1) / kHitGroup, 1u, 1u, hit_count));
  std::vector<std::uint32_t> listed(std::min<std::size_t>(dispatch[3], hits.size()));
  list.rays.download(std::as_writable_bytes(std::span(listed)));
  std::sort(listed.begin(), listed.end());
  EXPECT_TRUE(listed == expected) << "the list of hits differs from the hits";
}

std::size_t count_triangles(const TraceWorld& world) {
  std::size_t count = 0;
  for (const Instance& instance : world.instances) count += instance.primitive->indices.size() / 3;
  return count;
}

TraceResult trace(Tracer& tracer, const std::vector<Ray>& rays) {
  const auto count = static_cast<std::uint32_t>(rays.size());
  const std::uint32_t visibility_count = std::min(count, kMostVisibilityRays);
  gl::Buffer ray_buffer("rays", count * sizeof(Ray), gl::BufferUse::kHostVisible);
  gl::Buffer hit_buffer("hits", count * sizeof(Hit), gl::BufferUse::kHostVisible);
  gl::Buffer visible_buffer("visible", (count + 31) / 32 * sizeof(std::uint32_t), gl::BufferUse::kHostVisible);
  ray_buffer.upload(std::span<const Ray>(rays));
  HitList list(gl::BufferUse::kHostVisible);
  list.resize(count);
  tracer.closest_hit(ray_buffer, count, hit_buffer, &list);
  tracer.any_hit(ray_buffer, visibility_count, visible_buffer);
  TraceResult result;
  result.hits.resize(count);
  hit_buffer.download(std::as_writable_bytes(std::span(result.hits)));
  expect_lists(list, result.hits);
  std::vector<std::uint32_t> words((count + 31) / 32);
  visible_buffer.download(std::as_writable_bytes(std::span(words)));
  for (std::uint32_t i = 0; i < visibility_count; ++i) result.visible.push_back((words[i / 32] >> (i % 32) & 1u) != 0);
  return result;
}

}  // namespace

std::unique_ptr<gl::Context> TracerTest::context_;
std::map<std::string, std::unique_ptr<Tracer>> TracerTest::tracers_;

void TracerTest::SetUpTestSuite() {
  context_ = gl::Context::create();
  tracers_["compute"] = make_compute_tracer();
  tracers_["brute-force"] = make_brute_force_tracer();
#ifdef LIGHTWELL_HAS_EMBREE
  tracers_["embree"] = make_embree_tracer();
#else
  std::cout << "built without Embree: the tracers of the device alone are tested\n";
#endif
}

void TracerTest::TearDownTestSuite() {
  tracers_.clear();
  context_.reset();
}

void TracerTest::TearDown() {
  EXPECT_THAT(context_->take_debug_messages(), testing::IsEmpty());
}

std::map<std::string, TraceResult> TracerTest::trace_all(const TraceWorld& world, const std::vector<Ray>& rays) {
  std::map<std::string, TraceResult> results;
  const double tests = static_cast<double>(rays.size()) * static_cast<double>(count_triangles(world));
  for (auto& [name, tracer] : tracers_) {
    EXPECT_EQ(tracer->name(), name);
    if (name == "brute-force" && tests > kMostBruteForceTests) continue;
    tracer->update(world.scene());
    results[name] = trace(*tracer, rays);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < results[name].visible.size(); ++i)
      wrong += results[name].visible[i] == is_hit(results[name].hits[i]);
    EXPECT_EQ(wrong, 0u) << world.name << ": any_hit and closest_hit of " << name << " differ";
  }
  return results;
}

void TracerTest::expect_agreement(const TraceWorld& world, const std::vector<Ray>& rays, const std::vector<Hit>& a,
                                  const std::vector<Hit>& b, bool covered) {
  Agreement found = compare(world, rays, a, b);
  const auto total = static_cast<double>(std::max<std::size_t>(a.size(), 1));
  std::cout << world.name << ": " << a.size() << " rays, " << found.same << " same, " << found.ties
            << " ties in distance, " << found.edges << " at edges, " << found.rounded << " rounded, " << found.wrong
            << " wrong\n";
  if (covered) found.edges += std::exchange(found.wrong, 0);
  EXPECT_LT(static_cast<double>(found.ties + found.edges + found.rounded) / total, kMostTies) << world.name;
  if (found.wrong == 0) return;
  const Hit &x = a[found.first_wrong], &y = b[found.first_wrong];
  ADD_FAILURE() << world.name << ": ray " << found.first_wrong << " hits " << x.instance << '/' << x.triangle << " at "
                << x.t << " (" << x.u << ", " << x.v << ") or " << y.instance << '/' << y.triangle << " at " << y.t
                << " (" << y.u << ", " << y.v << ')';
}

}  // namespace lightwell::test
