// The wide hierarchy on the processor: rays one by one and rays along one direction meet what trying all triangles
// finds.
#include "renderer/tracing/world_hierarchy.h"

#include <gtest/gtest.h>

#include <cstring>

#include "renderer/lanes/choose.h"
#include "tests/unit/hierarchy_worlds.h"

namespace lightwell {
namespace {

using namespace test;

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
