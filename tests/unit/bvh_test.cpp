// Hierarchies as such: every item in one leaf, boxes that hold their contents, bounded depth, whatever the boxes.
#include "renderer/tracing/bvh.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>

namespace lightwell {
namespace {

bool holds(const Box& outer, const Box& inner) {
  return glm::all(glm::lessThanEqual(outer.min, inner.min)) && glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

std::vector<Box> random_boxes(std::size_t count, float size, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    const float x = number(), y = number(), z = number();
    const glm::vec3 corner{x, y, z};
    box.add(corner);
    box.add(corner + size * number());
  }
  return boxes;
}

// Checks the whole tree and returns its number of levels of inner nodes.
std::uint32_t check(const Bvh& bvh, const std::vector<Box>& boxes, const BvhLimits& limits) {
  std::vector<int> seen(boxes.size());
  const std::function<std::uint32_t(std::uint32_t, const Box&)> visit = [&](std::uint32_t child, const Box& box) {
    if (BvhChild::is_leaf(child)) {
      EXPECT_LE(BvhChild::count(child), limits.most_leaf_items);
      for (std::uint32_t i = 0; i < BvhChild::count(child); ++i) {
        const std::uint32_t item = bvh.items[BvhChild::first(child) + i];
        ++seen[item];
        EXPECT_TRUE(holds(box, boxes[item]));
      }
      return 0u;
    }
    const BvhNode& node = bvh.nodes[child];
    std::uint32_t levels = 0;
    for (int side = 0; side < 2; ++side) {
      EXPECT_TRUE(holds(box, node.boxes[side]));
      EXPECT_TRUE(BvhChild::is_leaf(node.children[side]) || node.children[side] > child);
      levels = std::max(levels, visit(node.children[side], node.boxes[side]));
    }
    return levels + 1;
  };
  const std::uint32_t levels = visit(bvh.root, bvh.bounds);
  for (const int count : seen) EXPECT_EQ(count, 1);
  EXPECT_LE(levels, limits.most_levels);
  return levels;
}

TEST(Bvh, HoldsEveryItemOnce) {
  for (const std::size_t count : {1u, 2u, 3u, 5u, 17u, 1000u, 20000u}) {
    const BvhLimits limits{4, 40};
    const std::vector<Box> boxes = random_boxes(count, 0.05f, 1);
    ThreadPool pool(3);
    check(build_bvh(boxes, limits, &pool), boxes, limits);
    check(build_bvh(boxes, limits, nullptr), boxes, limits);
  }
}

TEST(Bvh, IsTheSameForAnyNumberOfThreads) {
  const std::vector<Box> boxes = random_boxes(30000, 0.05f, 2);
  ThreadPool one(1), four(4);
  const Bvh a = build_bvh(boxes, {}, &one), b = build_bvh(boxes, {}, &four);
  EXPECT_EQ(a.items, b.items);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BvhNode)), 0);
}

TEST(Bvh, SurvivesBoxesThatNoPlaneSeparates) {
  const BvhLimits limits{4, 40};
  const std::vector<Box> same(5000, Box{glm::vec3(1.0f), glm::vec3(1.0f)});
  EXPECT_LE(check(build_bvh(same, limits, nullptr), same, limits), 13u);
  // Each box twice the last: the heuristic would peel them off one by one.
  std::vector<Box> doubling;
  for (int i = -120; i < 120; ++i) doubling.push_back({glm::vec3(0.0f), glm::vec3(std::ldexp(1.0f, i))});
  check(build_bvh(doubling, limits, nullptr), doubling, limits);
  const BvhLimits tight{1, 8};
  EXPECT_LE(check(build_bvh(doubling, tight, nullptr), doubling, tight), 8u);
}

TEST(Bvh, SurvivesHugeCoordinates) {
  std::vector<Box> boxes = random_boxes(200, 0.1f, 3);
  for (Box& box : boxes) box = {box.min * 3e38f, box.max * 3e38f};
  for (Box& box : boxes) box.max = glm::min(box.max, glm::vec3(3.4e38f));
  const BvhLimits limits{4, 40};
  check(build_bvh(boxes, limits, nullptr), boxes, limits);
}

TEST(Bvh, RefitHoldsMovedItemsAndItsCostTellsHowBadlyTheyMoved) {
  const BvhLimits limits{4, 40};
  const std::vector<Box> before = random_boxes(3000, 0.02f, 4);
  Bvh bvh = build_bvh(before, limits, nullptr);
  const float built = expected_cost(bvh);
  std::vector<Box> moved = before;
  for (Box& box : moved) box = {2.0f * box.min + 1.0f, 2.0f * box.max + 1.0f};
  refit_bvh(bvh, moved);
  check(bvh, moved, limits);
  EXPECT_NEAR(expected_cost(bvh), built, 0.01f * built);  // scaled as a whole: as good as before
  const std::vector<Box> shuffled = random_boxes(3000, 0.02f, 5);
  refit_bvh(bvh, shuffled);
  check(bvh, shuffled, limits);
  EXPECT_GT(expected_cost(bvh), 3.0f * built);
  refit_bvh(bvh, before);
  EXPECT_FLOAT_EQ(expected_cost(bvh), built);
}

TEST(Bvh, SplitsBetterThanHalves) {
  // Two clusters of very different size: the first split separates them.
  std::vector<Box> boxes = random_boxes(1000, 0.01f, 6);
  for (std::size_t i = 0; i < 20; ++i) boxes[i] = {boxes[i].min + 50.0f, boxes[i].max + 50.0f};
  const Bvh bvh = build_bvh(boxes, {}, nullptr);
  const BvhNode& root = bvh.nodes[bvh.root];
  EXPECT_LT(std::max(root.boxes[0].area(), root.boxes[1].area()), 0.01f * bvh.bounds.area());
}

}  // namespace
}  // namespace lightwell
