// Embree's builder for hierarchies of our own.
#pragma once

#include <embree3/rtcore.h>

#include <span>

#include "renderer/tracing/bvh.h"

namespace lightwell {

/// As build_bvh(), by the surface-area heuristic on all of Embree's threads, but that nothing of at most
/// `most_leaf_items` is split. At least one box. Throws std::runtime_error if memory runs out.
Bvh embree_bvh(RTCDevice device, std::span<const Box> boxes, std::uint32_t most_leaf_items);

}  // namespace lightwell
