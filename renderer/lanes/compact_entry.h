// Where rays along one direction come into a compact hierarchy: what they have in common is done once for all of them.
// For files that are compiled for a kind of processor: see renderer/lanes/glsl.h.
#pragma once

#include "renderer/lanes/parallel_rays.h"
#include "renderer/tracing/compact_hierarchy.h"

namespace lightwell::lanes {
namespace {

constexpr float kBoxRounding = 1.0000005f;  // of the slab test: Ize 2013, "Robust BVH Ray Traversal"

Ints load_bytes(const std::uint8_t* from) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return Ints(_mm512_maskz_cvtepu8_epi32(0xffff, _mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
#elif defined(__AVX2__)
  return Ints(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
#else
  Ints bytes;
  for (int i = 0; i < kLanes; ++i) bytes[i] = from[i];
  return bytes;
#endif
}

float step_of(const CompactNode& node, int axis) {
  const std::uint32_t bits = std::uint32_t{node.exponent[axis]} << 23;
  float step;
  __builtin_memcpy(&step, &bits, sizeof step);
  return step;
}

// The inverse of an axis that rays do not follow is so little tilted that no product is 0 * infinity.
float inverse_of(float along) {
  return 1.0f / (along * along < 1e-40f ? (along < 0.0f ? -1e-20f : 1e-20f) : along);
}

// From the world to an instance's space, or nowhere if it is null.
void place_direction(const CompactInstance* instance, const float* direction_ws, float* direction, float* inverse) {
  for (int axis = 0; axis < 3; ++axis) {
    const float* row = instance ? instance->object_from_world[axis] : nullptr;
    const float along =
        row ? row[0] * direction_ws[0] + row[1] * direction_ws[1] + row[2] * direction_ws[2] : direction_ws[axis];
    direction[axis] = along;
    inverse[axis] = inverse_of(along);
  }
}
void place_point(const CompactInstance* instance, const float* point_ws, float* point) {
  for (int axis = 0; axis < 3; ++axis) {
    const float* row = instance ? instance->object_from_world[axis] : nullptr;
    point[axis] = row ? row[0] * point_ws[0] + row[1] * point_ws[1] + row[2] * point_ws[2] + row[3] : point_ws[axis];
  }
}

// Not even nearly infinite.
bool is_finite(const float* vector) {
  return __builtin_fabsf(vector[0]) + __builtin_fabsf(vector[1]) + __builtin_fabsf(vector[2]) < 1e18f;
}

// The largest of the boxes that the rays meet are opened as long as there is room for what is in them.
class EntrySearch {
 public:
  EntrySearch(const CompactHierarchy& hierarchy, const ParallelRays& rays, CompactEntry& entry) : entry_(entry) {
    entry.within = hierarchy.instance_count == 1 ? &hierarchy.instances[0] : nullptr;
    nodes_ = entry.within ? entry.within->nodes : hierarchy.nodes;
    entry.count = 0;
    place_direction(entry.within, rays.direction_ws, entry.direction, entry.inverse);
    find_bounds(rays);
  }

  void run() {
    if (!is_finite(entry_.direction)) return;
    open(0);
    for (int opened = 0; opened < kMostOpened; ++opened) {
      const std::uint32_t largest = largest_node();
      if (largest == entry_.count) return;
      const std::uint32_t node = entry_.child[largest];
      const Child kept = child_at(largest);
      move_last_to(largest);
      if (open(node)) continue;
      put(kept);
      is_closed_ |= 1u << (entry_.count - 1);
    }
  }

 private:
  struct Child {
    float min[3], max[3];
    std::uint32_t child;
  };

  void find_bounds(const ParallelRays& rays) {
    for (std::uint32_t i = 0; i < rays.count; ++i) {
      const float from_ws[3] = {rays.from[0][i], rays.from[1][i], rays.from[2][i]};
      float from[3];
      place_point(entry_.within, from_ws, from);
      for (int axis = 0; axis < 3; ++axis) {
        least_[axis] = i == 0 || from[axis] < least_[axis] ? from[axis] : least_[axis];
        greatest_[axis] = i == 0 || from[axis] > greatest_[axis] ? from[axis] : greatest_[axis];
      }
    }
  }

  // Adds the children that the rays may meet. False if there is no room for them, or if their boxes lean.
  bool open(std::uint32_t number) {
    const CompactNode& node = nodes_[number];
    if (node.lean[0] != 0 || node.lean[1] != 0) return false;
    std::uint32_t lanes = 0;
    for (int first = 0; first < kWide; first += kLanes) {
      Float enters = 0.0, leaves = kNothing;
      for (int axis = 0; axis < 3; ++axis) {
        const float inverse = entry_.inverse[axis];
        const bool is_negative = inverse < 0.0f;
        const std::uint8_t* near_row = is_negative ? node.max[axis] : node.min[axis];
        const std::uint8_t* far_row = is_negative ? node.min[axis] : node.max[axis];
        const float near_offset = is_negative ? least_[axis] : greatest_[axis];
        const float far_offset = is_negative ? greatest_[axis] : least_[axis];
        const Float step = step_of(node, axis) * inverse;
        enters =
            max(to_float(load_bytes(&near_row[first])) * step + (node.origin[axis] - near_offset) * inverse, enters);
        leaves = min(to_float(load_bytes(&far_row[first])) * step + (node.origin[axis] - far_offset) * inverse, leaves);
      }
      lanes |= lane_bits(enters <= leaves * kBoxRounding) << first;
    }
    const std::uint32_t node_count = node.nodes & kCompactCountMask, leaf_count = node.leaves & kCompactCountMask;
    lanes &= (1u << (node_count + leaf_count)) - 1;
    if (entry_.count + static_cast<std::uint32_t>(__builtin_popcount(lanes)) > kWide) return false;
    if (lanes == 0) return true;
    alignas(64) float min[3][kWide], max[3][kWide];
    for (int axis = 0; axis < 3; ++axis) decode(node, axis, min[axis], max[axis]);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
      Child child;
      for (int axis = 0; axis < 3; ++axis) child.min[axis] = min[axis][lane], child.max[axis] = max[axis][lane];
      child.child = lane < node_count ? (node.nodes >> kCompactCountBits) + lane
                                      : ((node.leaves >> kCompactCountBits) + lane - node_count) | kWideLeafBit;
      put(child);
    }
    return true;
  }

  static void decode(const CompactNode& node, int axis, float* min, float* max) {
    const Float step = step_of(node, axis), origin = node.origin[axis];
    for (int first = 0; first < kWide; first += kLanes) {
      const Float low = to_float(load_bytes(&node.min[axis][first])) * step + origin;
      const Float high = to_float(load_bytes(&node.max[axis][first])) * step + origin;
      store(&min[first], (low - abs(low) * kRoom).v), store(&max[first], (high + abs(high) * kRoom).v);
    }
  }

  // Of those that may still be opened; past all if there is none.
  std::uint32_t largest_node() const {
    std::uint32_t largest = entry_.count;
    float largest_area = -1.0f;
    for (std::uint32_t i = 0; i < entry_.count; ++i) {
      if ((entry_.child[i] & kWideLeafBit) != 0 || (is_closed_ >> i & 1) != 0) continue;
      if (areas_[i] > largest_area) largest = i, largest_area = areas_[i];
    }
    return largest;
  }

  Child child_at(std::uint32_t i) const {
    return {{entry_.min[0][i], entry_.min[1][i], entry_.min[2][i]},
            {entry_.max[0][i], entry_.max[1][i], entry_.max[2][i]},
            entry_.child[i]};
  }
  void set(std::uint32_t i, const Child& child) {
    for (int axis = 0; axis < 3; ++axis) entry_.min[axis][i] = child.min[axis], entry_.max[axis][i] = child.max[axis];
    entry_.child[i] = child.child;
    const float x = child.max[0] - child.min[0], y = child.max[1] - child.min[1], z = child.max[2] - child.min[2];
    areas_[i] = x * y + y * z + z * x;
  }
  void put(const Child& child) { set(entry_.count++, child); }
  void move_last_to(std::uint32_t place) {
    const std::uint32_t last = --entry_.count;
    set(place, child_at(last));
    is_closed_ = (is_closed_ & ~(1u << place | 1u << last)) | (is_closed_ >> last & 1) << place;
  }

  static constexpr float kRoom = 1.2e-7f;  // for rounding
  static constexpr int kMostOpened = 7;    // further ones take more time than they spare

  CompactEntry& entry_;
  const CompactNode* nodes_;
  float least_[3], greatest_[3];  // of the origins
  float areas_[kWide];
  std::uint32_t is_closed_ = 0;  // a bit for each child that cannot be opened
};

void find_entry(const CompactHierarchy& hierarchy, const ParallelRays& rays, CompactEntry& entry) {
  EntrySearch(hierarchy, rays, entry).run();
}

}  // namespace
}  // namespace lightwell::lanes
