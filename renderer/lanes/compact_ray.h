// A ray on its way through a compact hierarchy. For files that are compiled for a kind of processor: see
// renderer/lanes/glsl.h.
#pragma once

#include "renderer/lanes/compact_entry.h"

namespace lightwell::lanes {
namespace {

// row[places] of a row of kWide.
Float picked(const float* row, Ints places) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  static_assert(kWide == kLanes);
  return Floats(_mm512_maskz_permutexvar_ps(0xffff, reinterpret_cast<__m512i>(places),
                                            reinterpret_cast<__m512>(load<Floats>(row))));
#else
  return gathered(row, places);
#endif
}

// What a ray meets of a node's children or of a leaf's triangles.
struct alignas(64) MetByRay {
  float near[kWide];                                   // distances
  float weight_b[kWide], weight_c[kWide], sum[kWide];  // of triangles: shares of the corners, times the sum
  std::uint32_t lanes;                                 // a bit for each that is met
};

// A ray on its way through the hierarchy. What takes long to compute is kept apart from what is decided by it: so a
// branch that goes another way than the processor expects costs little, and rays are computed with side by side.
class CompactRay {
 public:
  void start(const CompactHierarchy& hierarchy, const SingleRays& rays, std::uint32_t number) {
    const CompactEntry& entry = rays.entries[rays.entry[number]];
    hierarchy_ = &hierarchy;
    number_ = number;
    for (int axis = 0; axis < 3; ++axis) {
      origin_ws_[axis] = rays.from[axis][number], direction_ws_[axis] = rays.direction_ws[axis][number];
      direction_[axis] = entry.direction[axis], inverse_[axis] = entry.inverse[axis];
    }
    instance_ = entry.within;
    nodes_ = instance_ ? instance_->nodes : hierarchy.nodes;
    place_origin();
    far_ = kNothing;
    size_ = bottom_ = 0;
  }

  // Which of the entry's boxes may be met.
  void test_entry(const SingleRays& rays, MetByRay& met) const {
    const CompactEntry& entry = rays.entries[rays.entry[number_]];
    std::uint32_t lanes = 0;
    for (int first = 0; first < kWide; first += kLanes) {
      Float enters = 0.0, leaves = kNothing;
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_negative = inverse_[axis] < 0.0f;
        const float* near_row = is_negative ? entry.max[axis] : entry.min[axis];
        const float* far_row = is_negative ? entry.min[axis] : entry.max[axis];
        enters = max((load_float(&near_row[first]) - origin_[axis]) * inverse_[axis], enters);
        leaves = min((load_float(&far_row[first]) - origin_[axis]) * inverse_[axis], leaves);
      }
      store(&met.near[first], enters.v);
      lanes |= lane_bits(enters <= leaves * kBoxRounding) << first;
    }
    met.lanes = is_finite(origin_) ? lanes & ((1u << entry.count) - 1) : 0;
  }
  bool go_on_from_entry(const SingleRays& rays, const MetByRay& met) {
    const CompactEntry& entry = rays.entries[rays.entry[number_]];
    return go_to(met, [&](std::uint32_t lane) { return entry.child[lane]; });
  }

  bool is_at_leaf() const { return (next_ & kWideLeafBit) != 0; }

  // Which of the node's children may be met.
  void test_boxes(MetByRay& met) const {
    const CompactNode& node = nodes_[next_];
    float origin[3] = {origin_[0], origin_[1], origin_[2]}, inverse[3] = {inverse_[0], inverse_[1], inverse_[2]};
    const int leaning = node.leaning_axis, next = kNextAxis[leaning], last = kNextAxis[next];
    const float share = node.lean[0] * (1.0f / 128.0f), other_share = node.lean[1] * (1.0f / 128.0f);
    origin[leaning] += share * origin_[next] + other_share * origin_[last];
    inverse[leaning] = inverse_of(direction_[leaning] + share * direction_[next] + other_share * direction_[last]);
    std::uint32_t lanes = 0;
    for (int first = 0; first < kWide; first += kLanes) {
      Float enters = 0.0, leaves = far_;
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_negative = inverse[axis] < 0.0f;
        const std::uint8_t* near_row = is_negative ? node.max[axis] : node.min[axis];
        const std::uint8_t* far_row = is_negative ? node.min[axis] : node.max[axis];
        const Float start = (node.origin[axis] - origin[axis]) * inverse[axis];
        const Float step = step_of(node, axis) * inverse[axis];
        enters = max(to_float(load_bytes(&near_row[first])) * step + start, enters);
        leaves = min(to_float(load_bytes(&far_row[first])) * step + start, leaves);
      }
      store(&met.near[first], enters.v);
      lanes |= lane_bits(enters <= leaves * kBoxRounding) << first;
    }
    met.lanes = lanes & ((1u << ((node.nodes & kCompactCountMask) + (node.leaves & kCompactCountMask))) - 1);
  }

  // Goes on to the nearest child, or to what was left. False if there is nothing.
  bool go_on_from_node(const MetByRay& met) {
    const CompactNode& node = nodes_[next_];
    const std::uint32_t node_count = node.nodes & kCompactCountMask, first_node = node.nodes >> kCompactCountBits;
    const std::uint32_t first_leaf = ((node.leaves >> kCompactCountBits) | kWideLeafBit) - node_count;
    return go_to(met, [&](std::uint32_t lane) { return (lane < node_count ? first_node : first_leaf) + lane; });
  }

  // Which of the leaf's triangles are met. With the edges' moments (Pluecker coordinates) as Embree has them in its
  // robust mode, so that what an edge is to a ray is for the triangle on its other side just the opposite.
  void test_triangles(MetByRay& met) const {
    if (!instance_) return;
    const CompactLeaf& leaf = instance_->leaves[next_ & ~kWideLeafBit];
    const vec3 from = all_lanes(origin_), direction = all_lanes(direction_);
    std::uint32_t lanes = 0;
    for (int first = 0; first < kWide; first += kLanes) {
      const auto corner = [&](int i) {
        const Ints places = load_bytes(&leaf.corner[i][first]);
        return vec3(picked(leaf.position[0], places), picked(leaf.position[1], places),
                    picked(leaf.position[2], places)) -
               from;
      };
      const vec3 a = corner(0), b = corner(1), c = corner(2);
      const vec3 edge_b = c - a, edge_c = a - b, edge_a = b - c;  // those that lie opposite
      const Float weight_b = dot(cross(edge_b, c + a), direction), weight_c = dot(cross(edge_c, a + b), direction);
      const Float weight_a = dot(cross(edge_a, b + c), direction);
      const Float sum = weight_a + weight_b + weight_c, slack = abs(sum) * 1.2e-7f;
      const Mask inside =
          min(min(weight_a, weight_b), weight_c) >= -slack || max(max(weight_a, weight_b), weight_c) <= slack;
      const vec3 normal = cross(edge_b, edge_c);
      const Float height = dot(normal, direction), t = Floats(dot(a, normal).v / height.v);
      store(&met.near[first], t.v), store(&met.sum[first], sum.v);
      store(&met.weight_b[first], weight_b.v), store(&met.weight_c[first], weight_c.v);
      lanes |= lane_bits(inside && t > 0.0 && t < far_ && abs(height) > 0.0) << first;
    }
    met.lanes = lanes;
  }

  // Likewise.
  bool go_on_from_leaf(const MetByRay& met) {
    const std::uint32_t place = next_ & ~kWideLeafBit;
    if (!instance_) return enter(hierarchy_->instances[place]);
    if (met.lanes != 0) keep_nearest(instance_->leaves[place], met);
    return pop();
  }

  void store_hit(SingleRays& rays) const {
    rays.t[number_] = far_, rays.u[number_] = u_, rays.v[number_] = v_;
    if (!(far_ < kNothing)) return;
    const std::uint32_t* const firsts = hit_instance_->first_triangles;
    std::uint32_t primitive = 0;
    for (std::uint32_t end = hit_instance_->primitive_count; end - primitive > 1;) {
      const std::uint32_t middle = primitive + (end - primitive) / 2;
      (*triangle_ < firsts[middle] ? end : primitive) = middle;
    }
    rays.triangle[number_] = *triangle_ - firsts[primitive];
    rays.instance[number_] = hit_instance_->first_instance + primitive;
  }

 private:
  template <class ChildAt>
  bool go_to(const MetByRay& met, const ChildAt& child_at) {
    std::uint32_t left = met.lanes;
    if (left == 0) return pop();
    const auto pending = [&](std::uint32_t lane) { return Pending{bits_of(met.near[lane])} << 32 | child_at(lane); };
    Pending nearest = pending(static_cast<std::uint32_t>(__builtin_ctz(left)));
    for (left &= left - 1; left != 0; left &= left - 1) {
      const Pending other = pending(static_cast<std::uint32_t>(__builtin_ctz(left)));
      stack_[size_++] = other < nearest ? nearest : other;
      nearest = other < nearest ? other : nearest;
    }
    next_ = static_cast<std::uint32_t>(nearest);
    prefetch();
    return true;
  }

  void keep_nearest(const CompactLeaf& leaf, const MetByRay& met) {
    auto nearest = static_cast<std::uint32_t>(__builtin_ctz(met.lanes));
    for (std::uint32_t left = met.lanes & (met.lanes - 1); left != 0; left &= left - 1)
      if (const auto lane = static_cast<std::uint32_t>(__builtin_ctz(left)); met.near[lane] < met.near[nearest])
        nearest = lane;
    const float share = 1.0f / met.sum[nearest], u = met.weight_b[nearest] * share, v = met.weight_c[nearest] * share;
    far_ = met.near[nearest];
    u_ = u < 1.0f ? u : 1.0f, v_ = v < 1.0f ? v : 1.0f;
    triangle_ = &leaf.triangle[nearest];
    hit_instance_ = instance_;
    __builtin_prefetch(triangle_);
  }

  void go_to_world() {
    instance_ = nullptr;
    nodes_ = hierarchy_->nodes;
    bottom_ = 0;
    turn();
  }

  bool enter(const CompactInstance& instance) {
    instance_ = &instance;
    nodes_ = instance.nodes;
    bottom_ = size_;
    next_ = 0;
    turn();
    return true;
  }

  // To the space of the level at hand.
  void turn() {
    place_direction(instance_, direction_ws_, direction_, inverse_);
    place_origin();
  }
  void place_origin() { place_point(instance_, origin_ws_, origin_); }

  bool pop() {
    Pending child;
    do {
      if (size_ == bottom_) {
        if (size_ == 0) return false;
        go_to_world();
      }
      child = stack_[--size_];
    } while (child >> 32 > bits_of(far_));
    next_ = static_cast<std::uint32_t>(child);
    prefetch();
    return true;
  }

  void prefetch() const {
    const std::uint32_t place = next_ & ~kWideLeafBit;
    if (is_at_leaf() && !instance_) return;
    const char* to = is_at_leaf() ? reinterpret_cast<const char*>(&instance_->leaves[place])
                                  : reinterpret_cast<const char*>(&nodes_[place]);
    __builtin_prefetch(to), __builtin_prefetch(to + 64);
    if (is_at_leaf()) __builtin_prefetch(to + 128), __builtin_prefetch(to + 192);
  }

  static constexpr int kNextAxis[3] = {1, 2, 0};

  const CompactHierarchy* hierarchy_;
  const CompactInstance* instance_;              // null in the top level
  const CompactNode* nodes_;                     // of the level at hand
  float origin_[3], direction_[3], inverse_[3];  // in the space of the level at hand
  float far_, u_, v_;
  const std::uint32_t* triangle_;  // CompactLeaf::triangle of the hit
  const CompactInstance* hit_instance_;
  std::uint32_t number_;
  std::uint32_t next_;  // node, or leaf with kWideLeafBit
  std::uint32_t size_, bottom_;
  float origin_ws_[3], direction_ws_[3];
  Pending stack_[kMostCompactLevels * kWide];
};

}  // namespace
}  // namespace lightwell::lanes
