// The wide hierarchy on the processor: rays one by one and rays along one direction meet what trying all triangles
// finds.
#include "renderer/tracing/world_hierarchy.h"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <optional>
#include <random>

#include "renderer/lanes/choose.h"

namespace lightwell {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : random_(seed) {}
  float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  glm::vec3 in_box(float half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
  glm::vec3 direction() {
    for (;;) {
      const glm::vec3 point = in_box(1.0f);
      if (glm::dot(point, point) > 0.01f && glm::dot(point, point) < 1.0f) return glm::normalize(point);
    }
  }

 private:
  std::mt19937 random_;
};

std::shared_ptr<const Primitive> random_triangles(std::size_t count, float size_m, std::uint32_t seed) {
  Numbers numbers(seed);
  auto primitive = std::make_shared<Primitive>();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 center = numbers.in_box(2.0f);
    for (int corner = 0; corner < 3; ++corner) {
      primitive->indices.push_back(static_cast<std::uint32_t>(primitive->positions.size()));
      primitive->positions.push_back(center + numbers.in_box(size_m));
    }
  }
  return primitive;
}

Instance instance_of(std::shared_ptr<const Primitive> primitive, const glm::mat4& world_from_object, int node) {
  Instance instance;
  instance.primitive = std::move(primitive);
  instance.world_from_object = world_from_object;
  instance.node = node;
  return instance;
}

// Two placings of one mesh, one of them mirrored, and a small mesh of its own.
std::vector<Instance> crowd(float turn) {
  const auto shared = random_triangles(300, 0.4f, 1), small = random_triangles(5, 1.0f, 2);
  const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), turn, glm::vec3(0.6f, 0.8f, 0.0f));
  return {instance_of(shared, turned, 0),
          instance_of(shared, glm::scale(glm::translate(glm::mat4(1.0f), {3.0f, 0.5f, 0.0f}), {-1.0f, 2.0f, 0.5f}), 1),
          instance_of(small, glm::translate(turned, {0.0f, 3.0f, 1.0f}), 2)};
}

// By Moeller and Trumbore in doubles, over all triangles.
Hit brute_force(std::span<const Instance> instances, glm::vec3 origin_ws, glm::vec3 direction_ws) {
  Hit nearest{kMiss, 0, 0, 0.0f, 0.0f};
  const glm::dvec3 direction(direction_ws);
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const Primitive& primitive = *instances[i].primitive;
    for (std::uint32_t t = 0; t < primitive.indices.size() / 3; ++t) {
      glm::dvec3 corners[3];
      for (std::size_t c = 0; c < 3; ++c)
        corners[c] = glm::dvec3(glm::dmat4(instances[i].world_from_object) *
                                glm::dvec4(glm::dvec3(primitive.positions[primitive.indices[3 * t + c]]), 1.0));
      const glm::dvec3 b = corners[1] - corners[0], c = corners[2] - corners[0], across = glm::cross(direction, c);
      const glm::dvec3 way = glm::dvec3(origin_ws) - corners[0];
      const double inverse = 1.0 / glm::dot(b, across);
      const double u = glm::dot(way, across) * inverse, v = glm::dot(direction, glm::cross(way, b)) * inverse;
      const double distance = glm::dot(c, glm::cross(way, b)) * inverse;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || distance <= 0.0) continue;
      if (nearest.t >= 0.0f && distance >= static_cast<double>(nearest.t)) continue;
      nearest = {static_cast<float>(distance), i, t, static_cast<float>(u), static_cast<float>(v)};
    }
  }
  return nearest;
}

// Rays within rounding of an edge may find the other side of it.
struct Comparison {
  int rays = 0, hits = 0, different = 0;
  void add(const Hit& found, const Hit& expected) {
    ++rays;
    hits += expected.t >= 0.0f ? 1 : 0;
    const bool both = found.t >= 0.0f && expected.t >= 0.0f;
    const bool same = both ? found.instance == expected.instance && found.triangle == expected.triangle &&
                                 std::abs(found.t - expected.t) < 1e-4f && std::abs(found.u - expected.u) < 1e-3f &&
                                 std::abs(found.v - expected.v) < 1e-3f
                           : found.t < 0.0f && expected.t < 0.0f;
    different += same ? 0 : 1;
  }
  void expect_agreement() const {
    EXPECT_GT(hits, rays / 5);
    EXPECT_LT(hits, rays);
    EXPECT_LE(different, rays / 1000);
  }
};

const WideHierarchy* updated(WorldHierarchy& world, const std::vector<Instance>& instances) {
  static ThreadPool threads(2);
  const std::vector<Coverage> coverage(instances.size());
  return world.update({instances, coverage}, threads);
}

// What each ray of a direction meets.
std::vector<Hit> hits_of(const lanes::PatchKernels& kernels, const WideHierarchy& hierarchy,
                         std::span<const glm::vec3> origins, glm::vec3 direction) {
  const auto rays = std::make_unique<lanes::ParallelRays>();
  std::memset(rays.get(), 0, sizeof *rays);
  rays->count = static_cast<std::uint32_t>(origins.size());
  for (int axis = 0; axis < 3; ++axis) {
    rays->direction_ws[axis] = direction[axis];
    for (std::size_t i = 0; i < origins.size(); ++i) rays->from[axis][i] = origins[i][axis];
  }
  kernels.nearest_hits(hierarchy, *rays);
  std::vector<Hit> hits;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const WideLeaf& leaf = hierarchy.leaves[rays->triangle[i] / kWide];
    const std::uint32_t which = rays->triangle[i] % kWide;
    hits.push_back(rays->t[i] < kInfinity
                       ? Hit{rays->t[i], leaf.instance[which], leaf.triangle[which], rays->u[i], rays->v[i]}
                       : Hit{kMiss, 0, 0, 0.0f, 0.0f});
  }
  return hits;
}

class WorldHierarchyTest : public ::testing::TestWithParam<const lanes::PatchKernels*> {};

TEST_P(WorldHierarchyTest, ARayAloneMeetsWhatAllTrianglesGive) {
  WorldHierarchy world;
  for (const float turn : {0.0f, 0.7f, 2.0f}) {  // the same hierarchy, fitted anew
    const std::vector<Instance> instances = crowd(turn);
    const WideHierarchy* const hierarchy = updated(world, instances);
    ASSERT_NE(hierarchy, nullptr);
    Numbers numbers(3);
    Comparison comparison;
    for (int i = 0; i < 2000; ++i) {
      const glm::vec3 origin = numbers.in_box(5.0f), direction = glm::normalize(numbers.in_box(2.0f) - origin);
      comparison.add(hits_of(*GetParam(), *hierarchy, {&origin, 1}, direction)[0],
                     brute_force(instances, origin, direction));
    }
    comparison.expect_agreement();
  }
}

TEST_P(WorldHierarchyTest, ParallelRaysMeetWhatEachMeetsAlone) {
  WorldHierarchy world;
  const std::vector<Instance> instances = crowd(0.3f);
  const WideHierarchy* const hierarchy = updated(world, instances);
  ASSERT_NE(hierarchy, nullptr);
  Numbers numbers(4);
  Comparison comparison;
  for (const std::size_t count : {1u, 2u, 5u, 16u, 17u, 40u, 64u}) {
    for (const float spread_m : {0.0f, 0.05f, 1.0f}) {
      const glm::vec3 direction = spread_m == 1.0f ? glm::vec3(0.0f, -1.0f, 0.0f) : numbers.direction();
      const glm::vec3 center = 1.5f * numbers.direction() - 4.0f * direction;
      std::vector<glm::vec3> origins(count);
      for (glm::vec3& origin : origins) origin = center + numbers.in_box(1.0f) * spread_m;
      const std::vector<Hit> hits = hits_of(*GetParam(), *hierarchy, origins, direction);
      for (std::size_t i = 0; i < count; ++i) comparison.add(hits[i], brute_force(instances, origins[i], direction));
    }
  }
  comparison.expect_agreement();
}

TEST_P(WorldHierarchyTest, RaysThatAreNotFiniteMeetNothing) {
  WorldHierarchy world;
  const std::vector<Instance> instances = crowd(0.0f);
  const WideHierarchy& hierarchy = *updated(world, instances);
  const glm::vec3 nowhere(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f), here(0.0f);
  EXPECT_LT(hits_of(*GetParam(), hierarchy, {&nowhere, 1}, {0.0f, 1.0f, 0.0f})[0].t, 0.0f);
  EXPECT_LT(hits_of(*GetParam(), hierarchy, {&here, 1}, {0.0f, kInfinity, 0.0f})[0].t, 0.0f);
}

INSTANTIATE_TEST_SUITE_P(Processors, WorldHierarchyTest, ::testing::ValuesIn(lanes::usable_patch_kernels()),
                         [](const auto& tested) {
                           std::string name = tested.param->instructions;
                           std::erase(name, '-');
                           return name;
                         });

TEST(WorldHierarchy, IsForFewOpaqueTriangles) {
  static ThreadPool threads(1);
  WorldHierarchy world;
  EXPECT_EQ(updated(world, {}), nullptr);
  EXPECT_EQ(
      updated(world, {instance_of(random_triangles(WorldHierarchy::kMostTriangles + 1, 0.1f, 1), glm::mat4(1.0f), 0)}),
      nullptr);
  const std::vector<Instance> one{instance_of(random_triangles(1, 0.1f, 1), glm::mat4(1.0f), 0)};
  EXPECT_NE(updated(world, one), nullptr);
  Coverage masked;
  masked.mode = AlphaMode::kMask;
  const std::vector<Coverage> coverage{masked};
  EXPECT_EQ(world.update({one, coverage}, threads), nullptr);
}

// A deformed mesh that grows far beyond its first shape is sorted anew, and found everywhere on the way.
TEST(WorldHierarchy, FollowsWhatDeforms) {
  WorldHierarchy world;
  const auto primitive = random_triangles(200, 0.3f, 8);
  for (const float scale : {1.0f, 1.5f, 3.0f, 9.0f, 0.2f}) {
    std::vector<glm::vec3> positions;
    for (const glm::vec3& position : primitive->positions) positions.push_back(scale * position);
    std::vector<Instance> instances{instance_of(primitive, glm::mat4(1.0f), 0)};
    instances[0].deformed = std::make_shared<DeformedShape>(std::move(positions));
    const WideHierarchy* const hierarchy = updated(world, instances);
    ASSERT_NE(hierarchy, nullptr);
    const std::vector<Instance> rigid{instance_of(primitive, glm::scale(glm::mat4(1.0f), glm::vec3(scale)), 0)};
    Numbers numbers(5);
    Comparison comparison;
    for (int i = 0; i < 500; ++i) {
      const glm::vec3 origin = scale * numbers.in_box(2.0f), direction = numbers.direction();
      comparison.add(hits_of(lanes::patch_kernels(), *hierarchy, {&origin, 1}, direction)[0],
                     brute_force(rigid, origin, direction));
    }
    EXPECT_GT(comparison.hits, 50);
    EXPECT_LE(comparison.different, 2);
  }
}

}  // namespace
}  // namespace lightwell
