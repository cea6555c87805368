// Bounding volume hierarchies for the compute tracer, built on the CPU: binary, both children's boxes in their parent.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "renderer/tracing/thread_pool.h"

namespace lightwell {

struct Box {
  glm::vec3 min{std::numeric_limits<float>::infinity()};
  glm::vec3 max{-std::numeric_limits<float>::infinity()};  // empty: min > max

  void add(const glm::vec3& point);
  void add(const Box& box);
  /// Of the surface; 0 if empty.
  float area() const;
};

/// What a child is: an inner node's index, or a leaf's first item and count. Both fit 32 bits; trace.comp reads them.
struct BvhChild {
  static constexpr std::uint32_t kLeafBit = 0x80000000u;
  static constexpr std::uint32_t kCountShift = 27, kFirstMask = (1u << kCountShift) - 1;
  static constexpr std::uint32_t kMostItems = 1u << kCountShift, kMostLeafItems = 16;

  static std::uint32_t leaf(std::uint32_t first, std::uint32_t count) {
    return kLeafBit | (count - 1) << kCountShift | first;
  }
  static bool is_leaf(std::uint32_t child) { return (child & kLeafBit) != 0; }
  static std::uint32_t first(std::uint32_t child) { return child & kFirstMask; }
  static std::uint32_t count(std::uint32_t child) { return (child >> kCountShift & (kMostLeafItems - 1)) + 1; }
};

/// std430, 64 bytes.
struct BvhNode {
  Box boxes[2];
  std::uint32_t children[2] = {};
  std::uint32_t padding[2] = {};
};
static_assert(sizeof(BvhNode) == 64);

struct Bvh {
  std::uint32_t root = 0;            // a BvhChild; a leaf if there are no nodes
  std::vector<BvhNode> nodes;        // parents stand before their children
  std::vector<std::uint32_t> items;  // what leaves count through: indices into the boxes it was built from
  Box bounds;
};

struct BvhLimits {
  std::uint32_t most_leaf_items = 4;  // at most BvhChild::kMostLeafItems
  std::uint32_t most_levels = 40;     // of inner nodes; a traversal stack of as many entries suffices
};

/// Builds by binned surface-area heuristic, falling back to halves where that would grow deeper than the limit.
/// The same boxes give the same hierarchy whatever the number of threads. At least one box.
Bvh build_bvh(std::span<const Box> boxes, const BvhLimits& limits, ThreadPool* pool);

/// Fits the boxes of `bvh` to new boxes of the same items.
void refit_bvh(Bvh& bvh, std::span<const Box> boxes);

/// The expected cost of a ray that meets the bounds, by the surface-area heuristic.
float expected_cost(const Bvh& bvh);

}  // namespace lightwell
