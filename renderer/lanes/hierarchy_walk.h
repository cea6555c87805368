// Through a wide hierarchy, nearest boxes first, with what rays along one direction sweep together. For files that are
// compiled for a kind of processor: see renderer/lanes/glsl.h.
#pragma once

#include "renderer/lanes/parallel_rays.h"

namespace lightwell::lanes {
namespace {

// What the box around the rays' origins sweeps. An axis that the rays do not follow is tilted by so little that they
// stay in it, and no product is 0 * infinity.
struct Sweep {
  float inverse[3];  // of the direction
  float near_offset[3], far_offset[3];

  Sweep(const float* direction, const float* least, const float* greatest) {
    for (int axis = 0; axis < 3; ++axis) {
      const float along = direction[axis];
      const bool is_negative = along < 0.0f;
      inverse[axis] = 1.0f / (along * along < 1e-40f ? (is_negative ? -1e-20f : 1e-20f) : along);
      near_offset[axis] = is_negative ? least[axis] : greatest[axis];
      far_offset[axis] = is_negative ? greatest[axis] : least[axis];
    }
  }
};

class HierarchyWalk {
 public:
  HierarchyWalk(const WideHierarchy& hierarchy, const Sweep& sweep) : hierarchy_(hierarchy), sweep_(sweep) {}

  // try_leaf(leaf, number, far) gives how far is still to be looked.
  template <class TryLeaf>
  void follow(float far, const TryLeaf& try_leaf) {
    Pending next = hierarchy_.root;
    for (;;) {
      const std::uint32_t child = static_cast<std::uint32_t>(next), place = child & ~kWideLeafBit;
      if ((child & kWideLeafBit) != 0)
        far = try_leaf(hierarchy_.leaves[place], place, far);
      else
        push_children(hierarchy_.nodes[place], far);
      do {
        if (size_ == 0) return;
        next = stack_[--size_];
      } while (next >> 32 > bits_of(far));
    }
  }

 private:
  // The nearest comes to lie on top.
  void push_children(const WideNode& node, float far) {
    const std::uint32_t bottom = size_;
    for (int first = 0; first < kWide; first += kLanes) {
      Float enters = 0.0, leaves = far;
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_negative = sweep_.inverse[axis] < 0.0f;
        const float* near_row = is_negative ? node.max[axis] : node.min[axis];
        const float* far_row = is_negative ? node.min[axis] : node.max[axis];
        enters = max((load_float(&near_row[first]) - sweep_.near_offset[axis]) * sweep_.inverse[axis], enters);
        leaves = min((load_float(&far_row[first]) - sweep_.far_offset[axis]) * sweep_.inverse[axis], leaves);
      }
      alignas(64) std::uint32_t near[kLanes];
      store(near, enters.v);
      for (std::uint32_t met = lane_bits(enters <= leaves * kRounding); met != 0; met &= met - 1) {
        const int lane = __builtin_ctz(met);
        insert(bottom, Pending{near[lane]} << 32 | node.child[first + lane]);
      }
    }
  }

  void insert(std::uint32_t bottom, Pending child) {
    std::uint32_t place = size_++;
    for (; place > bottom && stack_[place - 1] < child; --place) stack_[place] = stack_[place - 1];
    stack_[place] = child;
  }

  static constexpr float kRounding = 1.0000005f;  // of the slab test: Ize 2013, "Robust BVH Ray Traversal"
  static constexpr std::uint32_t kMostLevels = 96;

  const WideHierarchy& hierarchy_;
  const Sweep sweep_;
  std::uint32_t size_ = 0;
  Pending stack_[kMostLevels * kWide];
};

void nearest_hits(const WideHierarchy& hierarchy, ParallelRays& rays) {
  ParallelLeaf leaf(rays);
  HierarchyWalk(hierarchy, Sweep(rays.direction_ws, leaf.least, leaf.greatest))
      .follow(kNothing,
              [&](const WideLeaf& at, std::uint32_t number, float far) { return leaf.try_leaf(at, number, far); });
}

}  // namespace
}  // namespace lightwell::lanes
