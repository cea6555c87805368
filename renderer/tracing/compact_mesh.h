// Compact hierarchies from binary ones.
#pragma once

#include <vector>

#include "renderer/tracing/bvh.h"
#include "renderer/tracing/compact_hierarchy.h"
#include "renderer/tracing/geometry_groups.h"

namespace lightwell {

/// The part of a compact hierarchy that lies below an instance, in the space of a group.
struct CompactMesh {
  std::vector<CompactNode> nodes;
  std::vector<CompactLeaf> leaves;
  std::vector<std::uint32_t> first_triangles;  // of each primitive
  Box bounds;
};

/// The group is not deformed. `bvh`: over its triangles, primitive by primitive; at most kWide of them a leaf, which
/// are put in another order.
CompactMesh compact_mesh(const GeometryGroup& group, Bvh& bvh, ThreadPool& threads);

/// The top level over boxes; leaves of the nodes count through `items`, which is emptied first.
std::vector<CompactNode> compact_top_level(std::span<const Box> boxes, std::vector<std::uint32_t>& items);

}  // namespace lightwell
