// The tracers against each other and against every triangle tried in double precision.
#include "renderer/tracing/tracer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iostream>
#include <limits>
#include <map>
#include <utility>

#include "renderer/gl/device.h"
#include "tests/gl/trace_scenes.h"
#ifdef LIGHTWELL_HAS_EMBREE
#include "renderer/tracing/embree/embree_tracer.h"
#endif

namespace lightwell::test {
namespace {

constexpr double kTieDistance = 1e-4;      // relative: nearer triangles than that cannot be told apart
constexpr float kEdgeBarycentric = 1e-4f;  // a hit nearer to its triangle's edge may as well pass it
constexpr double kMostTies = 1e-3;         // of all rays

struct Result {
  std::vector<Hit> hits;
  std::vector<bool> visible;
};

struct Agreement {
  std::size_t same = 0, ties = 0, edges = 0, rounded = 0, wrong = 0;
  std::size_t first_wrong = 0;
};

bool is_hit(const Hit& hit) {
  return hit.t >= 0.0f;
}

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

class TracerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    context_ = gl::Context::create();
    tracers_["compute"] = make_compute_tracer();
#ifdef LIGHTWELL_HAS_EMBREE
    tracers_["embree"] = make_embree_tracer();
#else
    std::cout << "built without Embree: the compute tracer alone is tested\n";
#endif
  }
  static void TearDownTestSuite() {
    tracers_.clear();
    context_.reset();
  }
  void TearDown() override {
    EXPECT_THAT(context_->take_debug_messages(), testing::IsEmpty());
  }

  // `visible` is of the first kMostVisibilityRays only: a software device is slow.
  static Result trace(Tracer& tracer, const std::vector<Ray>& rays) {
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
    Result result;
    result.hits.resize(count);
    hit_buffer.download(std::as_writable_bytes(std::span(result.hits)));
    expect_lists(list, result.hits);
    std::vector<std::uint32_t> words((count + 31) / 32);
    visible_buffer.download(std::as_writable_bytes(std::span(words)));
    for (std::uint32_t i = 0; i < visibility_count; ++i)
      result.visible.push_back((words[i / 32] >> (i % 32) & 1u) != 0);
    return result;
  }

  static void expect_lists(const HitList& list, const std::vector<Hit>& hits) {
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

  // Every tracer's results for these rays: any_hit is held against closest_hit, and the tracers against each other.
  static std::map<std::string, Result> trace_all(const TraceWorld& world, const std::vector<Ray>& rays) {
    std::map<std::string, Result> results;
    for (auto& [name, tracer] : tracers_) {
      tracer->update(world.scene());
      results[name] = trace(*tracer, rays);
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < results[name].visible.size(); ++i)
        wrong += results[name].visible[i] == is_hit(results[name].hits[i]);
      EXPECT_EQ(wrong, 0u) << world.name << ": any_hit and closest_hit of " << name << " differ";
    }
    return results;
  }

  static void expect_agreement(const TraceWorld& world, const std::vector<Ray>& rays, const std::vector<Hit>& a,
                               const std::vector<Hit>& b, bool covered = false) {
    Agreement found = compare(world, rays, a, b);
    const auto total = static_cast<double>(std::max<std::size_t>(a.size(), 1));
    std::cout << world.name << ": " << a.size() << " rays, " << found.same << " same, " << found.ties
              << " ties in distance, " << found.edges << " at edges, " << found.rounded << " rounded, " << found.wrong
              << " wrong\n";
    if (covered) found.edges += std::exchange(found.wrong, 0);
    EXPECT_LT(static_cast<double>(found.ties + found.edges + found.rounded) / total, kMostTies) << world.name;
    if (found.wrong == 0) return;
    const Hit &x = a[found.first_wrong], &y = b[found.first_wrong];
    ADD_FAILURE() << world.name << ": ray " << found.first_wrong << " hits " << x.instance << '/' << x.triangle
                  << " at " << x.t << " (" << x.u << ", " << x.v << ") or " << y.instance << '/' << y.triangle << " at "
                  << y.t << " (" << y.u << ", " << y.v << ')';
  }

  static constexpr std::uint32_t kMostVisibilityRays = 100'000;
  static std::unique_ptr<gl::Context> context_;
  static std::map<std::string, std::unique_ptr<Tracer>> tracers_;
};
std::unique_ptr<gl::Context> TracerTest::context_;
std::map<std::string, std::unique_ptr<Tracer>> TracerTest::tracers_;

TraceWorld instanced_world() {
  TraceWorld world;
  world.name = "instanced, scaled and mirrored";
  const auto mesh = random_triangles(300, 2.0f, 5);
  for (int i = 0; i < 12; ++i) {
    const float angle = 0.5f * static_cast<float>(i);
    glm::mat4 m = glm::translate(glm::mat4(1.0f), glm::vec3(3.0f * std::cos(angle), 0.4f * angle, std::sin(angle)));
    m = glm::rotate(m, angle, glm::normalize(glm::vec3(1.0f, angle, 0.3f)));
    m = glm::scale(m, glm::vec3(i % 2 == 0 ? 0.3f : -0.2f, 0.25f + 0.02f * angle, 0.1f));
    world.add(mesh, m);
  }
  return world;
}

// Leaves: random alpha of 16 x 16 texels on a soup of triangles, wrapped in every way.
TraceWorld covered_world(AlphaMode mode) {
  auto image = std::make_shared<Image>();
  image->size_px = {16, 16};
  std::mt19937 random(11);
  for (int i = 0; i < 16 * 16 * 4; ++i) image->rgba.push_back(static_cast<std::uint8_t>(random() >> 24));
  Coverage coverage;
  coverage.mode = mode;
  coverage.image = image;
  coverage.use.rotation = 0.3f;
  coverage.use.scale = {2.0f, 3.0f};
  coverage.use.offset = {-0.7f, 0.2f};
  TraceWorld world;
  world.name = mode == AlphaMode::kMask ? "masked" : "blended";
  for (std::uint32_t i = 0; i < 3; ++i) {
    coverage.wrap_s = static_cast<Wrap>(i);
    coverage.wrap_t = static_cast<Wrap>(2 - i);
    coverage.factor = mode == AlphaMode::kBlend ? 0.9f : 1.0f;
    world.add(random_triangles(3000, 1.5f, 20 + i), glm::mat4(1.0f), coverage);
  }
  world.add(random_triangles(1000, 1.0f, 24));
  return world;
}

TraceWorld world_of(std::string name, std::shared_ptr<const Primitive> primitive) {
  TraceWorld world;
  world.name = std::move(name);
  world.add(std::move(primitive));
  return world;
}

TEST_F(TracerTest, TracersAgreeOnAMillionRays) {
  if (tracers_.size() < 2) GTEST_SKIP() << "built without Embree: there is one tracer";
  const std::vector<std::pair<TraceWorld, std::uint32_t>> worlds = {
      {world_of("soup of 3000 triangles", random_triangles(3000, 1.0f, 30)), 1'000'000},
      {world_of("terrain of 80000 triangles", terrain(200)), 1'000'000},
      {world_of("closed shell of 80000 triangles", bumpy_shell(200)), 1'000'000},
      {instanced_world(), 1'000'000},
      {covered_world(AlphaMode::kMask), 200'000},
      {covered_world(AlphaMode::kBlend), 200'000}};
  for (const auto& [world, ray_count] : worlds) {
    const std::vector<Ray> rays = random_rays(world, ray_count, 31);
    const auto results = trace_all(world, rays);
    // A hit whose texel or threshold the last bit of a barycentric decides may differ: that is a tie as well.
    expect_agreement(world, rays, results.at("embree").hits, results.at("compute").hits,
                     world.coverage[0].mode != AlphaMode::kOpaque);
  }
}

TEST_F(TracerTest, AgreesWithBruteForce) {
  TraceWorld soup;
  soup.name = "soup against brute force";
  soup.add(random_triangles(500, 1.5f, 1));
  for (TraceWorld world : {soup, instanced_world()}) {
    world.name += ", brute force";
    const std::vector<Ray> rays = random_rays(world, 2000, 2);
    std::vector<Hit> expected;
    for (const Ray& ray : rays) expected.push_back(brute_force(world, ray).hit);
    for (const auto& [name, result] : trace_all(world, rays)) {
      expect_agreement(world, rays, expected, result.hits);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (expected[i].t < 0.0f || expected[i].triangle != result.hits[i].triangle) continue;
        EXPECT_NEAR(expected[i].u, result.hits[i].u, 1e-3f);
        EXPECT_NEAR(expected[i].v, result.hits[i].v, 1e-3f);
      }
    }
  }
}

TEST_F(TracerTest, RespectsTheIntervalOfARay) {
  TraceWorld world;
  world.name = "interval";
  world.add(random_triangles(500, 1.5f, 1));
  std::vector<Ray> rays = random_rays(world, 2000, 3);
  std::vector<Hit> expected;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].t_min = static_cast<float>(i % 7);
    rays[i].t_max = i % 5 == 0 ? -1.0f : rays[i].t_min + static_cast<float>(i % 11);
    expected.push_back(brute_force(world, rays[i]).hit);
  }
  for (const auto& [name, result] : trace_all(world, rays)) expect_agreement(world, rays, expected, result.hits);
}

TEST_F(TracerTest, AnEmptySceneAndNoRays) {
  TraceWorld world;
  world.name = "empty";
  const std::vector<Ray> rays = random_rays(world, 1000, 4);
  for (const auto& [name, result] : trace_all(world, rays))
    for (const Hit& hit : result.hits) EXPECT_EQ(hit.t, kMiss);
  trace_all(world, {});
  world.add(random_triangles(10, 1.0f, 4));
  trace_all(world, {});
}

TEST_F(TracerTest, ADegenerateTriangleIsNeverHit) {
  auto primitive = std::make_shared<Primitive>();
  primitive->positions = {{-5.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {5.0f, 0.0f, 0.0f}};
  primitive->indices = {0, 1, 2};
  TraceWorld world;
  world.name = "degenerate";
  world.add(primitive);
  std::vector<Ray> rays = random_rays(world, 1000, 5);
  rays.push_back({{1.0f, 3.0f, 0.0f}, 0.0f, {0.0f, -1.0f, 0.0f}, 10.0f});
  rays.push_back({{-9.0f, 0.0f, 0.0f}, 0.0f, {1.0f, 0.0f, 0.0f}, 100.0f});
  for (const auto& [name, result] : trace_all(world, rays))
    for (const Hit& hit : result.hits) EXPECT_EQ(hit.t, kMiss) << name;
}

// Embree's robust mode lets 1 ray in 1000 pass such a vertex; its default mode lets 1 in 7.
TEST_F(TracerTest, HardlyALeakThroughAClosedShellEvenAtItsVertices) {
  TraceWorld world;
  world.name = "closed shell";
  world.add(bumpy_shell(64));
  world.bounds_min = glm::vec3(-2.0f);
  world.bounds_max = glm::vec3(2.0f);
  // Straight at vertices and at the middles of edges, from a point that no symmetry favours.
  const Primitive& shell = *world.instances[0].primitive;
  const glm::vec3 eye{0.13f, -0.21f, 0.37f};
  std::vector<Ray> rays;
  for (std::size_t i = 0; i + 1 < shell.positions.size(); ++i) {
    rays.push_back({eye, 0.0f, glm::normalize(shell.positions[i] - eye), 1e30f});
    rays.push_back({eye, 0.0f, glm::normalize(0.5f * (shell.positions[i] + shell.positions[i + 1]) - eye), 1e30f});
  }
  for (const auto& [name, result] : trace_all(world, rays)) {
    std::size_t leaks = 0;
    for (const Hit& hit : result.hits) leaks += !is_hit(hit);
    EXPECT_LE(leaks * 500, rays.size()) << name;
  }
}

TEST_F(TracerTest, FollowsDeformedGeometry) {
  const auto rest = terrain(32);
  for (int frame = 0; frame < 6; ++frame) {
    TraceWorld world;
    world.name = "deformed, frame " + std::to_string(frame);
    world.add(rest);
    auto deformed = std::make_shared<DeformedVertices>();
    for (glm::vec3 p : rest->positions) {
      p.y += 0.8f * static_cast<float>(frame) * std::sin(p.x + 0.7f * static_cast<float>(frame));
      if (frame == 4) p *= 3.0f;  // far from where it was built
      deformed->positions.push_back(p);
    }
    world.instances[0].deformed = deformed;
    world.add(rest, glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, -9.0f, 0.0f)));
    const std::vector<Ray> rays = random_rays(world, 300, 6);
    std::vector<Hit> expected;
    for (const Ray& ray : rays) expected.push_back(brute_force(world, ray).hit);
    for (const auto& [name, result] : trace_all(world, rays)) expect_agreement(world, rays, expected, result.hits);
  }
}

TEST_F(TracerTest, GeometryThatWasDroppedIsBuiltAgain) {
  const TraceWorld world = world_of("dropped", random_triangles(200, 2.0f, 7));
  const TraceWorld other = world_of("another", random_triangles(300, 2.0f, 8));
  const std::vector<Ray> rays = random_rays(world, 1000, 9);
  const auto first = trace_all(world, rays);
  for (auto& [name, tracer] : tracers_)
    for (int frame = 0; frame < 200; ++frame) tracer->update(other.scene());
  trace_all(other, rays);
  const auto second = trace_all(world, rays);
  for (const auto& [name, result] : first) expect_agreement(world, rays, result.hits, second.at(name).hits);
}

TEST_F(TracerTest, AnObjectFlattenedByItsMatrixIsStillThere) {
  TraceWorld world;
  world.name = "flattened";
  world.add(terrain(4), glm::scale(glm::mat4(1.0f), glm::vec3(1.0f, 0.0f, 1.0f)));
  const std::vector<Ray> rays = {{{0.3f, 5.0f, 0.2f}, 0.0f, {0.0f, -1.0f, 0.0f}, 100.0f}};
  for (const auto& [name, result] : trace_all(world, rays)) EXPECT_FLOAT_EQ(result.hits[0].t, 5.0f) << name;
}

// One square of 2 x 2 texels whose alpha is 0, 100, 150 and 255.
TraceWorld covered_square(const Coverage& coverage) {
  auto image = std::make_shared<Image>();
  image->size_px = {2, 2};
  image->rgba = {9, 9, 9, 0, 9, 9, 9, 100, 9, 9, 9, 150, 9, 9, 9, 255};
  auto square = std::make_shared<Primitive>();
  square->positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
  square->uv0 = {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}};
  square->indices = {0, 1, 2, 0, 2, 3};
  TraceWorld world;
  world.name = "covered square";
  Coverage covered = coverage;
  covered.image = image;
  world.add(square, glm::mat4(1.0f), covered);
  return world;
}

std::vector<Ray> square_rays(std::uint32_t side) {
  std::vector<Ray> rays;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const glm::vec2 p = (glm::vec2(x, y) + 0.5f) / static_cast<float>(side);
      rays.push_back({{p, 1.0f}, 0.0f, {0.0f, 0.0f, -1.0f}, 10.0f});
    }
  return rays;
}

TEST_F(TracerTest, MaskHitsWhereAlphaReachesTheCutoff) {
  Coverage coverage;
  coverage.mode = AlphaMode::kMask;
  coverage.cutoff = 0.5f;
  coverage.factor = 0.9f;  // 150 / 255 * 0.9 = 0.53
  const TraceWorld world = covered_square(coverage);
  for (const auto& [name, result] : trace_all(world, square_rays(8)))
    for (int i = 0; i < 64; ++i) EXPECT_EQ(is_hit(result.hits[static_cast<std::size_t>(i)]), i / 8 >= 4) << name << i;
}

TEST_F(TracerTest, BlendHitsAsOftenAsAlphaSays) {
  Coverage coverage;
  coverage.mode = AlphaMode::kBlend;
  coverage.factor = 0.8f;
  const TraceWorld world = covered_square(coverage);
  constexpr std::uint32_t kSide = 256;
  for (const auto& [name, result] : trace_all(world, square_rays(kSide))) {
    double hits[4] = {};
    for (std::uint32_t i = 0; i < kSide * kSide; ++i)
      hits[(i / kSide) / (kSide / 2) * 2 + (i % kSide) / (kSide / 2)] += is_hit(result.hits[i]);
    const double alphas[4] = {0.0, 100.0 / 255.0, 150.0 / 255.0, 1.0};
    for (int texel = 0; texel < 4; ++texel) {
      const double p = 0.8 * alphas[texel], n = kSide * kSide / 4.0;
      EXPECT_NEAR(hits[texel], n * p, 4.0 * std::sqrt(n * p * (1.0 - p)) + 0.5) << name << " texel " << texel;
    }
  }
}

}  // namespace
}  // namespace lightwell::test
