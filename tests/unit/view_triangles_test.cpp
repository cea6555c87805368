// What the processor draws of a view, by each of its kinds of instructions, against rays in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "renderer/lanes/choose.h"
#include "renderer/passes/view_rasterizer.h"
#include "renderer/tracing/thread_pool.h"

namespace lightwell {
namespace {

constexpr glm::ivec2 kSize_px{61, 47};

ViewRays perspective_rays() {
  ViewRays rays;
  rays.origin_ws = {0.1f, 0.2f, 3.0f};
  rays.direction_ws = {-0.61f, 0.46f, -1.0f};
  rays.direction_across_ws = {0.02f, 0.001f, 0.0f};
  rays.direction_down_ws = {0.001f, -0.02f, 0.002f};
  rays.t_min = 0.05f, rays.t_max = 1e30f;
  rays.size_px = kSize_px;
  return rays;
}

ViewRays parallel_rays() {
  ViewRays rays;
  rays.origin_ws = {-1.5f, 1.2f, 4.0f};
  rays.origin_across_ws = {0.05f, 0.002f, 0.0f};
  rays.origin_down_ws = {0.0f, -0.05f, 0.001f};
  rays.direction_ws = {0.3f, -0.2f, -8.0f};
  rays.t_max = 1.0f;
  rays.size_px = kSize_px;
  return rays;
}

/// Threads, and no rays.
class Threads final : public HostTracer {
 public:
  void parallel_for(std::uint32_t count, std::uint32_t chunk,
                    const std::function<void(std::uint32_t, std::uint32_t)>& body) override {
    threads_.parallel_for(count, chunk, body);
  }
  void closest_hits(std::span<const Ray>, std::span<Hit>) const override {}
  const WideHierarchy* wide_hierarchy() override { return nullptr; }
  const CompactHierarchy* compact_hierarchy() override { return nullptr; }
  std::array<glm::vec3, 3> corners_ws(std::uint32_t, std::uint32_t) const override { return {}; }

 private:
  ThreadPool threads_{3};
};

/// One instance of some triangles.
class World {
 public:
  explicit World(std::vector<glm::vec3> corners, const glm::mat4& world_from_object = glm::mat4(1.0f)) {
    auto primitive = std::make_shared<Primitive>();
    primitive->positions = std::move(corners);
    for (std::uint32_t i = 0; i < primitive->positions.size(); ++i) primitive->indices.push_back(i);
    instances_.push_back({primitive, world_from_object, -1, -1, 0, nullptr});
    coverage_.emplace_back();
    coverage_[0].double_sided = true;
  }

  TraceScene scene() const { return {instances_, coverage_}; }
  Coverage& coverage() { return coverage_[0]; }
  std::size_t size() const { return instances_[0].primitive->indices.size() / 3; }
  glm::dvec3 corner_ws(std::size_t triangle, std::size_t corner) const {
    const glm::vec3 position = instances_[0].primitive->positions[3 * triangle + corner];
    return glm::dvec3(glm::dmat4(instances_[0].world_from_object) * glm::dvec4(position, 1.0));
  }

 private:
  std::vector<Instance> instances_;
  std::vector<Coverage> coverage_;
};

struct Met {
  double t, u, v;
  double inside;  // the least barycentric: how far from an edge
  bool from_front;
};

/// Of the plane of a triangle; none where the ray passes along it.
std::optional<Met> meet(const World& world, std::size_t triangle, const ViewRays& rays, glm::ivec2 pixel) {
  const double x = pixel.x, y = pixel.y;
  const glm::dvec3 origin =
      glm::dvec3(rays.origin_ws) + x * glm::dvec3(rays.origin_across_ws) + y * glm::dvec3(rays.origin_down_ws);
  const glm::dvec3 direction =
      glm::dvec3(rays.direction_ws) + x * glm::dvec3(rays.direction_across_ws) + y * glm::dvec3(rays.direction_down_ws);
  const glm::dvec3 a = world.corner_ws(triangle, 0), b = world.corner_ws(triangle, 1) - a,
                   c = world.corner_ws(triangle, 2) - a;
  const glm::dvec3 across = glm::cross(direction, c);
  const double determinant = glm::dot(b, across);
  if (std::abs(determinant) < 1e-12) return {};
  const double u = glm::dot(origin - a, across) / determinant;
  const double v = glm::dot(direction, glm::cross(origin - a, b)) / determinant;
  const double t = glm::dot(c, glm::cross(origin - a, b)) / determinant;
  return Met{t, u, v, std::min({u, v, 1.0 - u - v}), determinant > 0.0};
}

/// Every pixel's hit is the nearest there is, but for those within a rounding of an edge.
void expect_nearest(const World& world, const ViewRays& rays, const std::vector<Hit>& hits, bool fronts_alone) {
  constexpr double kEdge = 2e-3;
  for (int y = 0; y < kSize_px.y; ++y)
    for (int x = 0; x < kSize_px.x; ++x) {
      const Hit& hit = hits[static_cast<std::size_t>(y * kSize_px.x + x)];
      double surely = 1e30;  // what is met well within a triangle
      for (std::size_t triangle = 0; triangle < world.size(); ++triangle)
        if (const auto met = meet(world, triangle, rays, {x, y}); met && met->inside > kEdge)
          if (met->t > static_cast<double>(rays.t_min) && met->t < static_cast<double>(rays.t_max) &&
              (met->from_front || !fronts_alone))
            surely = std::min(surely, met->t);
      if (hit.t < 0.0f) {
        EXPECT_EQ(surely, 1e30) << x << " " << y;
        continue;
      }
      EXPECT_LE(static_cast<double>(hit.t), surely * (1.0 + 1e-4)) << x << " " << y;
      const auto met = meet(world, hit.triangle, rays, {x, y});
      ASSERT_TRUE(met) << x << " " << y;
      EXPECT_GT(met->inside, -kEdge) << x << " " << y;
      EXPECT_TRUE(met->from_front || !fronts_alone);
      EXPECT_NEAR(static_cast<double>(hit.t), met->t, 1e-4 * met->t + 1e-5);
      EXPECT_NEAR(static_cast<double>(hit.u), met->u, 2.0 * kEdge);
      EXPECT_NEAR(static_cast<double>(hit.v), met->v, 2.0 * kEdge);
    }
}

std::vector<Hit> hits_of(const World& world, const ViewRays& rays, const lanes::ViewKernels& kernels) {
  Threads threads;
  ViewRasterizer rasterizer(threads, kernels);
  rasterizer.update(world.scene());
  std::vector<Hit> hits(static_cast<std::size_t>(kSize_px.x) * static_cast<std::size_t>(kSize_px.y));
  rasterizer.camera_hits(rays, hits.data());
  return hits;
}

/// Of all sizes and ways round; some reach behind the eye, some far out of the picture.
World triangles_of_all_sizes(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-3.0f, 3.0f), part(-1.0f, 1.0f), size(-6.0f, 2.5f);
  std::vector<glm::vec3> corners;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 at(place(random), place(random), place(random));
    const float extent = std::exp2(size(random));
    for (int corner = 0; corner < 3; ++corner)
      corners.push_back(at + extent * glm::vec3(part(random), part(random), part(random)));
  }
  return World(std::move(corners));
}

TEST(ViewTriangles, AreTheNearestAtEveryPixel) {
  World world = triangles_of_all_sizes(700);
  for (const lanes::ViewKernels* kernels : lanes::usable_view_kernels())
    for (const ViewRays& rays : {perspective_rays(), parallel_rays()})
      for (const bool fronts_alone : {false, true}) {
        SCOPED_TRACE(kernels->instructions);
        world.coverage().double_sided = !fronts_alone;
        expect_nearest(world, rays, hits_of(world, rays, *kernels), fronts_alone);
      }
}

/// A wall of unlike quads that fills the view, its front towards the eye.
World wall(int columns, const glm::mat4& world_from_object) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> aside(-0.3f, 0.3f);
  const auto count = static_cast<std::size_t>(columns) + 1;
  std::vector<glm::vec3> grid, corners;
  for (std::size_t i = 0; i < count * count; ++i) {
    const glm::vec2 at(static_cast<float>(i % count) + aside(random), static_cast<float>(i / count) + aside(random));
    grid.emplace_back(16.0f * at / static_cast<float>(columns) - 8.0f, 0.1f * aside(random));
  }
  for (std::size_t y = 0; y + 1 < count; ++y)
    for (std::size_t x = 0; x + 1 < count; ++x) {
      const std::size_t a = y * count + x, b = a + 1, c = a + count, d = c + 1;
      for (const std::size_t i : {a, b, d, a, d, c}) corners.push_back(grid[i]);
    }
  return World(std::move(corners), world_from_object);
}

TEST(ViewTriangles, LeaveNoPixelBetweenThem) {
  const glm::mat4 turned(0.96f, 0, 0.28f, 0, 0, 1, 0, 0, -0.28f, 0, 0.96f, 0, 0, 0, 0, 1);
  const glm::mat4 mirrored(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  for (const int columns : {1, 7, 60, 400})
    for (const glm::mat4& matrix : {glm::mat4(1.0f), turned, mirrored}) {
      World world = wall(columns, matrix);
      world.coverage().double_sided = false;
      for (const lanes::ViewKernels* kernels : lanes::usable_view_kernels())
        for (const ViewRays& rays : {perspective_rays(), parallel_rays()})
          for (const Hit& hit : hits_of(world, rays, *kernels)) ASSERT_GE(hit.t, 0.0f) << columns;
    }
}

TEST(ViewTriangles, DepthsKnowTheirSlopes) {
  const World world = wall(60, glm::mat4(0.8f, 0, 0.6f, 0, 0, 1, 0, 0, -0.6f, 0, 0.8f, 0, 0, 0, 0, 1));
  for (const lanes::ViewKernels* kernels : lanes::usable_view_kernels())
    for (const DepthMeasure measure : {DepthMeasure::kAlongView, DepthMeasure::kDistance}) {
      SCOPED_TRACE(kernels->instructions);
      const ViewRays rays = perspective_rays();
      Threads threads;
      ViewRasterizer rasterizer(threads, *kernels);
      rasterizer.update(world.scene());
      std::vector<ViewDepth> depths(static_cast<std::size_t>(kSize_px.x) * static_cast<std::size_t>(kSize_px.y));
      rasterizer.depths(rays, measure, 0.5f, depths.data());
      const std::vector<Hit> hits = hits_of(world, rays, *kernels);
      for (int y = 0; y < kSize_px.y; ++y)
        for (int x = 0; x < kSize_px.x; ++x) {
          const auto at = static_cast<std::size_t>(y * kSize_px.x + x);
          const auto depth_at = [&](int to_x, int to_y) {
            const glm::dvec3 direction = glm::dvec3(rays.direction_ws) +
                                         static_cast<double>(to_x) * glm::dvec3(rays.direction_across_ws) +
                                         static_cast<double>(to_y) * glm::dvec3(rays.direction_down_ws);
            const double t = meet(world, hits[at].triangle, rays, {to_x, to_y})->t;
            return 0.5 * t * (measure == DepthMeasure::kDistance ? glm::length(direction) : 1.0);
          };
          const double across = 0.5 * (depth_at(x + 1, y) - depth_at(x - 1, y));
          const double down = 0.5 * (depth_at(x, y + 1) - depth_at(x, y - 1));
          EXPECT_NEAR(static_cast<double>(depths[at].depth), depth_at(x, y), 1e-4);
          EXPECT_NEAR(std::sqrt(static_cast<double>(depths[at].slope2)), std::hypot(across, down),
                      0.02 * std::hypot(across, down) + 1e-4);
        }
    }
}

TEST(ViewTriangles, OfADegenerateViewAreNowhere) {
  const World world = triangles_of_all_sizes(100);
  ViewRays flat = perspective_rays();
  flat.direction_down_ws = flat.direction_across_ws;
  ViewRays infinite = parallel_rays();
  infinite.origin_ws.x = INFINITY;
  for (const lanes::ViewKernels* kernels : lanes::usable_view_kernels())
    for (const ViewRays& rays : {flat, infinite})
      for (const Hit& hit : hits_of(world, rays, *kernels)) EXPECT_LT(hit.t, 0.0f);
}

}  // namespace
}  // namespace lightwell
