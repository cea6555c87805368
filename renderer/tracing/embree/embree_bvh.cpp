#include "renderer/tracing/embree/embree_bvh.h"

#include <memory>
#include <new>
#include <stdexcept>

namespace lightwell {
namespace {

struct ReleaseBvh {
  void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};

// What Embree's callbacks make: an inner node, or a leaf, which has a count.
struct Built {
  Built* children[2];
  Box boxes[2];
  std::uint32_t first, count;
};

Box box_of(const RTCBounds& bounds) {
  return {{bounds.lower_x, bounds.lower_y, bounds.lower_z}, {bounds.upper_x, bounds.upper_y, bounds.upper_z}};
}

Built* new_built(RTCThreadLocalAllocator allocator) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(Built), alignof(Built))) Built{};
}
void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return new_built(allocator);
}
void set_children(void* node, void** children, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i) static_cast<Built*>(node)->children[i] = static_cast<Built*>(children[i]);
}
void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i) static_cast<Built*>(node)->boxes[i] = box_of(*bounds[i]);
}
void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* items, std::size_t count, void* all) {
  Built* leaf = new_built(allocator);
  leaf->first = static_cast<std::uint32_t>(items - static_cast<const RTCBuildPrimitive*>(all));
  leaf->count = static_cast<std::uint32_t>(count);
  return leaf;
}

// Parents come before their children.
void append(const Built& root, Bvh& bvh) {
  const auto place_of = [](const Built& leaf) { return BvhChild::leaf(leaf.first, leaf.count); };
  if (root.count > 0) {
    bvh.root = place_of(root);
    return;
  }
  std::vector<std::pair<const Built*, std::uint32_t>> pending{{&root, 0}};
  bvh.nodes.emplace_back();
  while (!pending.empty()) {
    const auto [built, node] = pending.back();
    pending.pop_back();
    for (int side = 0; side < 2; ++side) {
      const Built& child = *built->children[side];
      bvh.nodes[node].boxes[side] = built->boxes[side];
      bvh.nodes[node].children[side] = child.count > 0 ? place_of(child) : static_cast<std::uint32_t>(bvh.nodes.size());
      if (child.count > 0) continue;
      pending.emplace_back(&child, static_cast<std::uint32_t>(bvh.nodes.size()));
      bvh.nodes.emplace_back();
    }
  }
}

}  // namespace

Bvh embree_bvh(RTCDevice device, std::span<const Box> boxes, std::uint32_t most_leaf_items) {
  std::vector<RTCBuildPrimitive> items;
  items.reserve(boxes.size());
  Bvh bvh;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[i];
    items.push_back({box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, i});
    bvh.bounds.add(box);
  }
  const std::unique_ptr<RTCBVHTy, ReleaseBvh> built{rtcNewBVH(device)};
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.maxBranchingFactor = 2;
  arguments.maxDepth = 40;
  arguments.sahBlockSize = most_leaf_items;
  arguments.minLeafSize = most_leaf_items;
  arguments.maxLeafSize = most_leaf_items;
  arguments.bvh = built.get();
  arguments.primitives = items.data();
  arguments.primitiveCount = arguments.primitiveArrayCapacity = items.size();
  arguments.createNode = create_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  arguments.userPtr = items.data();
  const auto* root = static_cast<const Built*>(rtcBuildBVH(&arguments));
  if (!root) throw std::runtime_error("Embree could not build a hierarchy");
  append(*root, bvh);
  bvh.items.reserve(items.size());
  for (const RTCBuildPrimitive& item : items) bvh.items.push_back(item.primID);
  return bvh;
}

}  // namespace lightwell
