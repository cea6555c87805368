// Leaves of compact hierarchies.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "renderer/tracing/bvh.h"
#include "renderer/tracing/compact_hierarchy.h"
#include "renderer/tracing/geometry_groups.h"

namespace lightwell {

/// The triangles of a group that is not deformed, by their numbers in a hierarchy.
class GroupTriangles {
 public:
  explicit GroupTriangles(const GeometryGroup& group) : group_(group) {
    std::uint32_t first = 0;
    for (const Primitive* primitive : group.key.primitives) {
      firsts_.push_back(first);
      first += static_cast<std::uint32_t>(primitive->indices.size() / 3);
    }
  }

  const std::vector<std::uint32_t>& firsts() const { return firsts_; }

  std::array<const glm::vec3*, 3> corners(std::uint32_t number) const {
    const auto primitive_index =
        static_cast<std::size_t>(std::upper_bound(firsts_.begin(), firsts_.end(), number) - firsts_.begin() - 1);
    const Primitive& primitive = *group_.key.primitives[primitive_index];
    const glm::vec3* positions = primitive.positions.data();
    const std::uint32_t* indices = &primitive.indices[std::size_t{3} * (number - firsts_[primitive_index])];
    return {positions + indices[0], positions + indices[1], positions + indices[2]};
  }

  Box box_of(std::uint32_t number) const {
    Box box;
    for (const glm::vec3* corner : corners(number)) box.add(*corner);
    return box;
  }

 private:
  const GeometryGroup& group_;
  std::vector<std::uint32_t> firsts_;  // of each primitive
};

/// The items of a BvhChild that is a leaf.
inline std::span<const std::uint32_t> items_of(const Bvh& bvh, std::uint32_t leaf) {
  return std::span(bvh.items).subspan(BvhChild::first(leaf), BvhChild::count(leaf));
}

/// `numbers`: at most kWide. False if there is no room for so many corners.
bool fill_leaf(CompactLeaf& leaf, const GroupTriangles& triangles, std::span<const std::uint32_t> numbers);

/// Leaves of `bvh`, of at most kWide triangles, that have too many corners become nodes over smaller ones.
void split_crowded_leaves(const GroupTriangles& triangles, Bvh& bvh, ThreadPool& threads);

}  // namespace lightwell
