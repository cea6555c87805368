#include "renderer/tracing/compact_leaves.h"

#include <algorithm>

namespace lightwell {
namespace {

bool is_crowded(const GroupTriangles& triangles, const Bvh& bvh, std::uint32_t leaf) {
  CompactLeaf scratch;
  return !fill_leaf(scratch, triangles, items_of(bvh, leaf));
}

// A leaf whose triangles have too many corners becomes a node over its halves.
class SplitLeaf {
 public:
  SplitLeaf(const GroupTriangles& triangles, Bvh& bvh) : triangles_(triangles), bvh_(bvh) {}

  std::uint32_t split(std::uint32_t leaf) {
    const std::uint32_t first = BvhChild::first(leaf), half = BvhChild::count(leaf) / 2;
    sort_along_widest(leaf);
    const auto node = static_cast<std::uint32_t>(bvh_.nodes.size());
    bvh_.nodes.emplace_back();
    const std::uint32_t halves[2] = {BvhChild::leaf(first, half),
                                     BvhChild::leaf(first + half, BvhChild::count(leaf) - half)};
    for (int side = 0; side < 2; ++side) {
      bvh_.nodes[node].boxes[side] = box_of(halves[side]);
      const std::uint32_t child = is_crowded(triangles_, bvh_, halves[side]) ? split(halves[side]) : halves[side];
      bvh_.nodes[node].children[side] = child;
    }
    return node;
  }

 private:
  Box box_of(std::uint32_t leaf) const {
    Box box;
    for (const std::uint32_t item : items_of(bvh_, leaf)) box.add(triangles_.box_of(item));
    return box;
  }

  void sort_along_widest(std::uint32_t leaf) {
    const Box box = box_of(leaf);
    const glm::vec3 size = box.max - box.min;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = bvh_.items.begin() + BvhChild::first(leaf);
    std::sort(begin, begin + BvhChild::count(leaf), [&](std::uint32_t a, std::uint32_t b) {
      const Box box_a = triangles_.box_of(a), box_b = triangles_.box_of(b);
      const float x = box_a.min[axis] + box_a.max[axis], y = box_b.min[axis] + box_b.max[axis];
      return x < y || (x == y && a < b);
    });
  }

  const GroupTriangles& triangles_;
  Bvh& bvh_;
};

}  // namespace

bool fill_leaf(CompactLeaf& leaf, const GroupTriangles& triangles, std::span<const std::uint32_t> numbers) {
  leaf = {};
  std::array<const glm::vec3*, kWide> known;
  std::size_t count = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    leaf.triangle[i] = numbers[i];
    const std::array<const glm::vec3*, 3> corners = triangles.corners(numbers[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto place =
          static_cast<std::size_t>(std::find(known.begin(), known.begin() + count, corners[c]) - known.begin());
      if (place == known.size()) return false;
      leaf.corner[c][i] = static_cast<std::uint8_t>(place);
      if (place < count) continue;
      known[count++] = corners[c];
      for (int axis = 0; axis < 3; ++axis) leaf.position[axis][place] = (*corners[c])[axis];
    }
  }
  return true;
}

void split_crowded_leaves(const GroupTriangles& triangles, Bvh& bvh, ThreadPool& threads) {
  SplitLeaf split_leaf(triangles, bvh);
  if (BvhChild::is_leaf(bvh.root)) {
    if (is_crowded(triangles, bvh, bvh.root)) bvh.root = split_leaf.split(bvh.root);
    return;
  }
  const std::size_t count = bvh.nodes.size();
  std::vector<std::uint8_t> crowded(2 * count);
  threads.parallel_for(static_cast<std::uint32_t>(2 * count), 1024, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t child = bvh.nodes[i / 2].children[i % 2];
      crowded[i] = BvhChild::is_leaf(child) && is_crowded(triangles, bvh, child) ? 1 : 0;
    }
  });
  for (std::size_t i = 0; i < crowded.size(); ++i) {
    if (crowded[i] == 0) continue;
    const std::uint32_t node = split_leaf.split(bvh.nodes[i / 2].children[i % 2]);
    bvh.nodes[i / 2].children[i % 2] = node;
  }
}

}  // namespace lightwell
