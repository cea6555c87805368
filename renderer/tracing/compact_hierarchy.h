// A hierarchy over very many triangles that leaves little to fetch from memory: the nodes of a smooth mesh take about
// 1.2 bytes a triangle, which a processor's caches hold, the leaves 31. Plain data and no functions, for it is read by
// code that is compiled for several kinds of processor (renderer/lanes/).
#pragma once

#include <cstdint>

#include "renderer/tracing/wide_hierarchy.h"

namespace lightwell {

/// Boxes of up to kWide children, in steps of a grid: from origin + step * min to origin + step * max, metres. Nodes
/// come before leaves, and both lie side by side. Along one axis boxes may lean with a surface: of a point that
/// coordinate then counts with shares of both others, the next axis' first.
struct alignas(128) CompactNode {
  float origin[3];
  std::uint32_t nodes;        // the first one << kCompactCountBits | how many
  std::uint32_t leaves;       // likewise; of the top level: instances
  std::uint8_t exponent[3];   // of the steps, as of a float
  std::uint8_t leaning_axis;  // 0 to 2
  std::int8_t lean[2];        // 128ths; 0: upright, as the root is
  std::uint8_t padding[6];
  std::uint8_t min[3][kWide], max[3][kWide];
};
static_assert(sizeof(CompactNode) == 128);
constexpr std::uint32_t kCompactCountBits = 5, kCompactCountMask = (1u << kCompactCountBits) - 1;

/// Up to kWide triangles of a mesh and their corners, object space, metres. What is left over has no extent. The
/// processor's memory brings 64 bytes at a time: the last of them are for triangles that are met.
struct alignas(64) CompactLeaf {
  float position[3][kWide];
  std::uint8_t corner[3][kWide];  // of triangles, in `position`
  std::uint8_t padding[kWide];
  std::uint32_t triangle[kWide];  // of the mesh, primitive by primitive
};
static_assert(sizeof(CompactLeaf) == 320);

/// A mesh in the world.
struct CompactInstance {
  float object_from_world[3][4];  // rows
  const CompactNode* nodes;       // the first is the root
  const CompactLeaf* leaves;
  const std::uint32_t* first_triangles;  // of each primitive
  std::uint32_t primitive_count;
  std::uint32_t first_instance;  // in Pose::instances; that of a hit is its primitive further
};

struct CompactHierarchy {
  const CompactNode* nodes;  // over the instances; the first is the root
  const CompactInstance* instances;
  std::uint32_t instance_count;
};

/// Where rays along one direction from near by come into a hierarchy: what the boxes around all of them meet.
struct alignas(64) CompactEntry {
  float min[3][kWide], max[3][kWide];
  std::uint32_t child[kWide];      // node, or leaf with kWideLeafBit
  std::uint32_t count;             // 0: the rays meet nothing
  const CompactInstance* within;   // whose space the boxes are in; null: the world, and leaves are instances
  float direction[3], inverse[3];  // in that space
};

/// Levels of nodes, of the top level and of a mesh together.
constexpr std::uint32_t kMostCompactLevels = 80;

}  // namespace lightwell
