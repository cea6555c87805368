// A hierarchy of boxes for the processor's vectors. Plain data and no functions, for it is read by code that is
// compiled for several kinds of processor (renderer/lanes/).
#pragma once

#include <cstdint>

namespace lightwell {

/// Children of a node, triangles of a leaf: what is tested at once.
constexpr int kWide = 16;

/// Boxes of children, world space, metres.
struct alignas(64) WideNode {
  float min[3][kWide], max[3][kWide];  // an empty child: min is infinite, max minus infinite
  std::uint32_t child[kWide];          // node, or leaf with kWideLeafBit
};
constexpr std::uint32_t kWideLeafBit = 0x80000000u;

/// Triangles, world space, metres. What is left over has no extent.
struct alignas(64) WideLeaf {
  float corner[3][kWide], to_second[3][kWide], to_third[3][kWide];
  float normal[3][kWide];         // to_second x to_third
  std::uint32_t instance[kWide];  // in Pose::instances
  std::uint32_t triangle[kWide];  // in Primitive::indices / 3
};

struct WideHierarchy {
  const WideNode* nodes;
  const WideLeaf* leaves;
  std::uint32_t root;  // node
};

}  // namespace lightwell
