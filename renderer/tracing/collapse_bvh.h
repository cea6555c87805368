// Wide nodes from binary ones.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/tracing/bvh.h"
#include "renderer/tracing/wide_hierarchy.h"

namespace lightwell {

/// Items of a hierarchy that lie together: Bvh::items[first, first + count).
struct BvhRange {
  std::uint32_t first, count;
};

/// The largest subtrees of at most `most_items`.
std::vector<BvhRange> subtrees_of(const Bvh& bvh, std::uint32_t most_items);

/// Wide nodes over the same items, which have a leaf of `bvh` each: an item is a leaf of the wide nodes, by its number.
/// Opens the largest boxes first; `nodes` is emptied first, the root comes to be its first.
void collapse_bvh(const Bvh& bvh, std::vector<WideNode>& nodes);

}  // namespace lightwell
