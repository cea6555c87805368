#include "renderer/tracing/bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "renderer/check.h"
#include "renderer/tracing/bindings.glsl"

namespace lightwell {
namespace {

constexpr auto kNodeCost = static_cast<float>(TRACE_NODE_COST), kItemCost = static_cast<float>(TRACE_ITEM_COST);
constexpr std::size_t kBins = 16;
constexpr std::uint32_t kParallelItems = 8192;  // smaller hierarchies are built by one thread

struct Range {
  std::uint32_t begin, end;
  std::uint32_t count() const { return end - begin; }
};

struct Split {
  int axis;
  float position;  // centroids below go left
  float cost;
};

// A subtree left to be built, and the place in its parent that refers to it.
struct Subtree {
  Range range;
  Box box;
  std::uint32_t level;
  std::uint32_t parent;
  int slot;
};

class Builder {
 public:
  Builder(std::span<const Box> boxes, const BvhLimits& limits, std::vector<std::uint32_t>& items)
      : boxes_(boxes), limits_(limits), items_(items) {
    centroids_.reserve(boxes.size());
    for (const Box& box : boxes) centroids_.push_back(0.5f * box.min + 0.5f * box.max);
  }

  Box bounds_of(Range range) const {
    Box box;
    for (std::uint32_t i = range.begin; i < range.end; ++i) box.add(boxes_[items_[i]]);
    return box;
  }

  // Splits depth first from `tree` down, appending to `nodes`. Ranges of at most `deferred_items` that are no leaf are
  // not split but handed to `defer`.
  template <class Defer>
  void build(const Subtree& tree, std::vector<BvhNode>& nodes, std::uint32_t deferred_items, const Defer& defer) {
    std::vector<Subtree> stack{tree};
    while (!stack.empty()) {
      const Subtree top = stack.back();
      stack.pop_back();
      if (top.range.count() <= deferred_items) {
        defer(top);
        continue;
      }
      const auto node = static_cast<std::uint32_t>(nodes.size());
      nodes.emplace_back();
      if (top.parent != kNoParent) nodes[top.parent].children[top.slot] = node;
      const std::uint32_t middle = partition(top.range, top.box, levels_left(top));
      const Range halves[2] = {{top.range.begin, middle}, {middle, top.range.end}};
      // The right one first, so that the left one is built next and lies beside its parent.
      for (const int side : {1, 0}) {
        const Box box = bounds_of(halves[side]);
        nodes[node].boxes[side] = box;
        if (is_leaf(halves[side], box))
          nodes[node].children[side] = BvhChild::leaf(halves[side].begin, halves[side].count());
        else
          stack.push_back({halves[side], box, top.level + 1, node, side});
      }
    }
  }

  bool is_leaf(Range range, const Box& box) const {
    if (range.count() == 1) return true;
    if (range.count() > limits_.most_leaf_items) return false;
    const std::optional<Split> split = best_split(range, box);
    return !split || split->cost >= kItemCost * static_cast<float>(range.count());
  }

  static constexpr std::uint32_t kNoParent = ~0u;

 private:
  std::uint32_t levels_left(const Subtree& tree) const { return limits_.most_levels - tree.level; }

  std::uint32_t partition(Range range, const Box& box, std::uint32_t levels) {
    // Halving needs this many levels; with none to spare, halve.
    const auto needed = static_cast<std::uint32_t>(std::bit_width(range.count() - 1));
    const std::optional<Split> split = needed < levels ? best_split(range, box) : std::nullopt;
    const auto begin = items_.begin() + range.begin, end = items_.begin() + range.end;
    if (!split) {
      const int axis = widest_axis(range);
      const auto middle = begin + range.count() / 2;
      std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
        const float x = centroids_[a][axis], y = centroids_[b][axis];
        return x < y || (x == y && a < b);
      });
      return range.begin + range.count() / 2;
    }
    const auto middle =
        std::partition(begin, end, [&](std::uint32_t item) { return centroids_[item][split->axis] < split->position; });
    return static_cast<std::uint32_t>(middle - items_.begin());
  }

  Box centroid_bounds(Range range) const {
    Box box;
    for (std::uint32_t i = range.begin; i < range.end; ++i) box.add(centroids_[items_[i]]);
    return box;
  }

  int widest_axis(Range range) const {
    const Box box = centroid_bounds(range);
    const glm::vec3 size = box.max - box.min;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  }

  // "On fast Construction of SAH-based Bounding Volume Hierarchies", Wald 2007. Nothing if no plane separates anything.
  std::optional<Split> best_split(Range range, const Box& box) const {
    const Box centroids = centroid_bounds(range);
    const float scale = box.area() > 0.0f ? kItemCost / box.area() : 0.0f;
    std::optional<Split> best;
    for (int axis = 0; axis < 3; ++axis) {
      const float origin = centroids.min[axis];
      const float bin_width = (centroids.max[axis] - origin) / static_cast<float>(kBins);
      if (!(bin_width > 0.0f) || !std::isfinite(bin_width)) continue;
      std::array<Box, kBins - 1> left_boxes;  // of all bins up to each plane
      std::array<std::uint32_t, kBins - 1> left_counts = {};
      std::array<Box, kBins> boxes;
      std::array<std::uint32_t, kBins> counts = {};
      // Bins are bounded by the very planes that `partition` compares with.
      std::array<float, kBins - 1> planes;
      for (std::size_t i = 0; i + 1 < kBins; ++i) planes[i] = origin + bin_width * static_cast<float>(i + 1);
      for (std::uint32_t i = range.begin; i < range.end; ++i) {
        const float centroid = centroids_[items_[i]][axis];
        auto bin = std::min(static_cast<std::size_t>((centroid - origin) / bin_width), kBins - 1);
        while (bin > 0 && centroid < planes[bin - 1]) --bin;
        while (bin + 1 < kBins && centroid >= planes[bin]) ++bin;
        boxes[bin].add(boxes_[items_[i]]);
        ++counts[bin];
      }
      Box swept;
      std::uint32_t count = 0;
      for (std::size_t i = 0; i + 1 < kBins; ++i) {
        swept.add(boxes[i]);
        left_boxes[i] = swept;
        left_counts[i] = count += counts[i];
      }
      swept = {};
      count = 0;
      for (std::size_t i = kBins - 1; i > 0; --i) {
        swept.add(boxes[i]);
        count += counts[i];
        if (count == 0 || left_counts[i - 1] == 0) continue;
        const float cost = kNodeCost + scale * (left_boxes[i - 1].area() * static_cast<float>(left_counts[i - 1]) +
                                                swept.area() * static_cast<float>(count));
        if (!best || cost < best->cost) best = Split{axis, planes[i - 1], cost};
      }
    }
    return best;
  }

  std::span<const Box> boxes_;
  BvhLimits limits_;
  std::vector<std::uint32_t>& items_;
  std::vector<glm::vec3> centroids_;
};

// Appends a subtree's nodes and makes their parent refer to them.
void append(const Subtree& tree, const std::vector<BvhNode>& subtree, std::vector<BvhNode>& nodes) {
  const auto base = static_cast<std::uint32_t>(nodes.size());
  nodes[tree.parent].children[tree.slot] = base;
  for (BvhNode node : subtree) {
    for (std::uint32_t& child : node.children)
      if (!BvhChild::is_leaf(child)) child += base;
    nodes.push_back(node);
  }
}

}  // namespace

void Box::add(const glm::vec3& point) {
  min = glm::min(min, point);
  max = glm::max(max, point);
}

void Box::add(const Box& box) {
  min = glm::min(min, box.min);
  max = glm::max(max, box.max);
}

float Box::area() const {
  if (!(min.x <= max.x)) return 0.0f;
  const glm::vec3 size = max - min;
  return 2.0f * (size.x * size.y + size.y * size.z + size.z * size.x);
}

Bvh build_bvh(std::span<const Box> boxes, const BvhLimits& limits, ThreadPool* pool) {
  LIGHTWELL_CHECK_OP(boxes.size(), >, 0u);
  LIGHTWELL_CHECK_OP(boxes.size(), <, std::size_t{BvhChild::kMostItems});
  LIGHTWELL_CHECK_OP(limits.most_leaf_items, <=, BvhChild::kMostLeafItems);
  LIGHTWELL_CHECK_OP(static_cast<std::uint32_t>(std::bit_width(boxes.size())), <=, limits.most_levels);
  Bvh bvh;
  const auto count = static_cast<std::uint32_t>(boxes.size());
  bvh.items.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) bvh.items[i] = i;
  Builder builder(boxes, limits, bvh.items);
  bvh.bounds = builder.bounds_of({0, count});
  if (builder.is_leaf({0, count}, bvh.bounds)) {
    bvh.root = BvhChild::leaf(0, count);
    return bvh;
  }

  // The top is split by this thread into subtrees that all threads then build. Their number does not depend on the
  // number of threads, so that neither does the result.
  std::vector<Subtree> subtrees;
  const std::uint32_t subtree_items = pool && count >= kParallelItems ? count / 32 : 0;
  builder.build({{0, count}, bvh.bounds, 0, Builder::kNoParent, 0}, bvh.nodes, subtree_items,
                [&](const Subtree& tree) { subtrees.push_back(tree); });
  std::vector<std::vector<BvhNode>> parts(subtrees.size());
  const auto build_part = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      Subtree root = subtrees[i];
      root.parent = Builder::kNoParent;
      builder.build(root, parts[i], 0, [](const Subtree&) {});
    }
  };
  if (pool) pool->parallel_for(static_cast<std::uint32_t>(subtrees.size()), 1, build_part);
  for (std::size_t i = 0; i < subtrees.size(); ++i) append(subtrees[i], parts[i], bvh.nodes);
  return bvh;
}

void refit_bvh(Bvh& bvh, std::span<const Box> boxes) {
  LIGHTWELL_CHECK_OP(boxes.size(), ==, bvh.items.size());
  const auto box_of = [&](std::uint32_t child) {
    Box box;
    if (BvhChild::is_leaf(child)) {
      for (std::uint32_t k = 0; k < BvhChild::count(child); ++k) box.add(boxes[bvh.items[BvhChild::first(child) + k]]);
    } else {
      for (const Box& half : bvh.nodes[child].boxes) box.add(half);
    }
    return box;
  };
  for (std::size_t i = bvh.nodes.size(); i-- > 0;)
    for (int side = 0; side < 2; ++side) bvh.nodes[i].boxes[side] = box_of(bvh.nodes[i].children[side]);
  bvh.bounds = box_of(bvh.root);
}

float expected_cost(const Bvh& bvh) {
  const float area = bvh.bounds.area();
  if (!(area > 0.0f)) return 0.0f;
  float cost = kNodeCost * area;
  for (const BvhNode& node : bvh.nodes)
    for (int side = 0; side < 2; ++side) {
      const std::uint32_t child = node.children[side];
      const float child_cost =
          BvhChild::is_leaf(child) ? kItemCost * static_cast<float>(BvhChild::count(child)) : kNodeCost;
      cost += child_cost * node.boxes[side].area();
    }
  return cost / area;
}

}  // namespace lightwell
