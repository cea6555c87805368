// The compact hierarchy on the processor: rays meet what trying all triangles finds.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "renderer/lanes/choose.h"
#include "renderer/tracing/compact_scene.h"
#include "tests/unit/hierarchy_worlds.h"

namespace lightwell {
namespace {

using namespace test;

const CompactHierarchy* updated(CompactScene& scene, const std::vector<Instance>& instances) {
  static ThreadPool threads(2);
  const std::vector<Coverage> coverage(instances.size());
  return scene.update({instances, coverage}, threads, [](std::span<const Box> boxes) {
    return build_bvh(boxes, {kWide, 40}, &threads);
  });
}

// Rays along one direction.
struct Beam {
  glm::vec3 direction;
  std::vector<glm::vec3> origins;
};

std::vector<Hit> hits_of(const lanes::PatchKernels& kernels, const CompactHierarchy& hierarchy,
                         std::span<const Beam> beams) {
  const auto parallel = std::make_unique<lanes::ParallelRays>();
  const auto rays = std::make_unique<lanes::SingleRays>();
  std::memset(parallel.get(), 0, sizeof *parallel);
  std::memset(rays.get(), 0, sizeof *rays);
  for (const Beam& beam : beams) {
    parallel->count = static_cast<std::uint32_t>(beam.origins.size());
    for (int axis = 0; axis < 3; ++axis) {
      parallel->direction_ws[axis] = beam.direction[axis];
      for (std::size_t i = 0; i < beam.origins.size(); ++i) {
        parallel->from[axis][i] = rays->from[axis][rays->count + i] = beam.origins[i][axis];
        rays->direction_ws[axis][rays->count + i] = beam.direction[axis];
        rays->entry[rays->count + i] = static_cast<std::uint8_t>(rays->entry_count);
      }
    }
    rays->count += parallel->count;
    kernels.find_entry(hierarchy, *parallel, rays->entries[rays->entry_count++]);
  }
  kernels.nearest_single_hits(hierarchy, *rays);
  std::vector<Hit> hits;
  for (std::uint32_t i = 0; i < rays->count; ++i)
    hits.push_back(rays->t[i] < kInfinity
                       ? Hit{rays->t[i], rays->instance[i], rays->triangle[i], rays->u[i], rays->v[i]}
                       : Hit{kMiss, 0, 0, 0.0f, 0.0f});
  return hits;
}

Hit hit_of(const lanes::PatchKernels& kernels, const CompactHierarchy& hierarchy, glm::vec3 origin,
           glm::vec3 direction) {
  const Beam beam{direction, {origin}};
  return hits_of(kernels, hierarchy, {&beam, 1})[0];
}

// A sheet of hills whose triangles share their corners.
std::shared_ptr<const Primitive> hills(std::uint32_t side) {
  auto primitive = std::make_shared<Primitive>();
  for (std::uint32_t row = 0; row <= side; ++row)
    for (std::uint32_t column = 0; column <= side; ++column) {
      const float x = 4.0f * static_cast<float>(column) / static_cast<float>(side) - 2.0f;
      const float z = 4.0f * static_cast<float>(row) / static_cast<float>(side) - 2.0f;
      primitive->positions.emplace_back(x, 0.8f * std::sin(2.0f * x) * std::cos(1.5f * z), z);
      if (row == side || column == side) continue;
      const std::uint32_t corner = row * (side + 1) + column, below = corner + side + 1;
      primitive->indices.insert(primitive->indices.end(), {corner, below, corner + 1, corner + 1, below, below + 1});
    }
  return primitive;
}

// A closed ball around the origin, of radius 1.
std::shared_ptr<const Primitive> ball(std::uint32_t side) {
  auto primitive = std::make_shared<Primitive>();
  const auto vertex = [&](std::uint32_t row, std::uint32_t column) { return row * side + column % side; };
  for (std::uint32_t row = 0; row <= side; ++row)
    for (std::uint32_t column = 0; column < side; ++column) {
      const float polar = 3.14159265f * static_cast<float>(row) / static_cast<float>(side);
      const float around = 6.2831853f * static_cast<float>(column) / static_cast<float>(side);
      const float ring = row == 0 || row == side ? 0.0f : std::sin(polar);
      primitive->positions.emplace_back(ring * std::cos(around), std::cos(polar), ring * std::sin(around));
      if (row == side) continue;
      const std::uint32_t corners[] = {vertex(row, column),     vertex(row, column + 1),     vertex(row + 1, column),
                                       vertex(row, column + 1), vertex(row + 1, column + 1), vertex(row + 1, column)};
      primitive->indices.insert(primitive->indices.end(), std::begin(corners), std::end(corners));
    }
  return primitive;
}

class CompactHierarchyTest : public ::testing::TestWithParam<const lanes::PatchKernels*> {
 protected:
  static void expect_what_all_triangles_give(const std::vector<Instance>& instances,
                                             const CompactHierarchy* hierarchy) {
    ASSERT_NE(hierarchy, nullptr);
    Numbers numbers(3);
    Comparison comparison;
    for (int i = 0; i < 2000; ++i) {
      const glm::vec3 origin = numbers.in_box(5.0f), direction = glm::normalize(numbers.in_box(2.0f) - origin);
      comparison.add(hit_of(*GetParam(), *hierarchy, origin, direction), brute_force(instances, origin, direction));
    }
    comparison.expect_agreement();
  }
};

TEST_P(CompactHierarchyTest, ARayAloneMeetsWhatAllTrianglesGive) {
  CompactScene scene;
  for (const float turn : {0.0f, 0.7f, 2.0f}) {  // the same meshes, placed anew
    const std::vector<Instance> instances = crowd(turn);
    expect_what_all_triangles_give(instances, updated(scene, instances));
  }
}

TEST_P(CompactHierarchyTest, KnowsOneMeshAloneAndTurned) {
  const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 0.9f, glm::vec3(0.0f, 0.6f, 0.8f));
  for (const glm::mat4& placed : {glm::mat4(1.0f), turned, glm::scale(turned, {-1.0f, 0.5f, 2.0f})}) {
    CompactScene scene;
    const std::vector<Instance> instances{instance_of(hills(40), placed, 0)};
    expect_what_all_triangles_give(instances, updated(scene, instances));
  }
}

TEST_P(CompactHierarchyTest, KnowsThePrimitivesOfANode) {
  CompactScene scene;
  const std::vector<Instance> instances{instance_of(hills(12), glm::mat4(1.0f), 4),
                                        instance_of(random_triangles(90, 0.5f, 7), glm::mat4(1.0f), 4),
                                        instance_of(random_triangles(1, 2.0f, 8), glm::mat4(1.0f), 4),
                                        instance_of(random_triangles(1, 2.0f, 9), glm::mat4(1.0f), 5)};
  expect_what_all_triangles_give(instances, updated(scene, instances));
}

TEST_P(CompactHierarchyTest, RaysTogetherMeetWhatEachMeetsAlone) {
  Numbers numbers(4);
  for (const bool is_crowd : {true, false}) {
    CompactScene scene;
    const std::vector<Instance> instances =
        is_crowd ? crowd(0.3f) : std::vector<Instance>{instance_of(hills(30), glm::mat4(1.0f), 0)};
    const CompactHierarchy* const hierarchy = updated(scene, instances);
    ASSERT_NE(hierarchy, nullptr);
    Comparison comparison;
    for (const float spread_m : {0.0f, 0.05f, 1.0f}) {
      std::vector<Beam> beams;
      for (const std::size_t count : {1u, 2u, 5u, 17u, 40u, 64u, 64u, 63u}) {
        Beam& beam = beams.emplace_back();
        beam.direction = count == 17u ? glm::vec3(0.0f, -1.0f, 0.0f) : numbers.direction();
        const glm::vec3 center = 1.5f * numbers.direction() - 4.0f * beam.direction;
        for (std::size_t i = 0; i < count; ++i) beam.origins.push_back(center + numbers.in_box(1.0f) * spread_m);
      }
      const std::vector<Hit> hits = hits_of(*GetParam(), *hierarchy, beams);
      std::size_t ray = 0;
      for (const Beam& beam : beams)
        for (const glm::vec3& origin : beam.origins)
          comparison.add(hits[ray++], brute_force(instances, origin, beam.direction));
    }
    comparison.expect_agreement();
  }
}

// Straight at corners and at the middles of edges, from a point that no symmetry favours.
TEST_P(CompactHierarchyTest, HardlyALeakThroughAClosedBall) {
  CompactScene scene;
  const auto shell = ball(60);
  const CompactHierarchy* const hierarchy = updated(scene, {instance_of(shell, glm::mat4(1.0f), 0)});
  ASSERT_NE(hierarchy, nullptr);
  const glm::vec3 eye{0.13f, -0.21f, 0.37f};
  std::size_t rays = 0, leaks = 0;
  for (std::size_t i = 0; i + 1 < shell->positions.size(); ++i)
    for (const float share : {0.0f, 0.5f}) {
      const glm::vec3 target = glm::mix(shell->positions[i], shell->positions[i + 1], share);
      ++rays;
      leaks += hit_of(*GetParam(), *hierarchy, eye, glm::normalize(target - eye)).t < 0.0f ? 1 : 0;
    }
  EXPECT_LE(leaks * 500, rays);
}

TEST_P(CompactHierarchyTest, RaysThatAreNotFiniteMeetNothing) {
  CompactScene scene;
  const CompactHierarchy& hierarchy = *updated(scene, crowd(0.0f));
  const glm::vec3 nowhere(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f), here(0.0f);
  EXPECT_LT(hit_of(*GetParam(), hierarchy, nowhere, {0.0f, 1.0f, 0.0f}).t, 0.0f);
  EXPECT_LT(hit_of(*GetParam(), hierarchy, here, {0.0f, kInfinity, 0.0f}).t, 0.0f);
  EXPECT_LT(hit_of(*GetParam(), hierarchy, here, nowhere).t, 0.0f);
}

INSTANTIATE_TEST_SUITE_P(Processors, CompactHierarchyTest, ::testing::ValuesIn(lanes::usable_patch_kernels()),
                         [](const auto& tested) {
                           std::string name = tested.param->instructions;
                           std::erase(name, '-');
                           return name;
                         });

TEST(CompactHierarchy, IsForRigidOpaqueTriangles) {
  static ThreadPool threads(1);
  CompactScene scene;
  EXPECT_EQ(updated(scene, {}), nullptr);
  std::vector<Instance> one{instance_of(random_triangles(1, 0.1f, 1), glm::mat4(1.0f), 0)};
  EXPECT_NE(updated(scene, one), nullptr);
  EXPECT_GT(scene.memory_bytes(), 0u);
  Coverage masked;
  masked.mode = AlphaMode::kMask;
  const std::vector<Coverage> coverage{masked};
  EXPECT_EQ(scene.update({one, coverage}, threads, {}), nullptr);
  one[0].deformed = std::make_shared<DeformedShape>(one[0].primitive->positions);
  EXPECT_EQ(updated(scene, one), nullptr);
}

}  // namespace
}  // namespace lightwell
