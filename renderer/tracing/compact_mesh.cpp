#include "renderer/tracing/compact_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/tracing/compact_leaves.h"

namespace lightwell {
namespace {

constexpr BvhLimits kInstanceLimits{1, 32};

// A BvhChild and its box.
struct BvhBox {
  std::uint32_t child;
  Box box;
};

// From where to where children reach along each axis.
struct Extents {
  std::vector<std::array<double, 2>> along[3];
};

Extents extents_of(std::span<const BvhBox> children) {
  Extents extents;
  for (int axis = 0; axis < 3; ++axis)
    for (const BvhBox& child : children) extents.along[axis].push_back({child.box.min[axis], child.box.max[axis]});
  return extents;
}

// The grid has room beyond the boxes, for rounding in the walk.
void set_boxes(CompactNode& node, const Extents& extents) {
  constexpr double kRoom = 0.02;  // steps
  for (int axis = 0; axis < 3; ++axis) {
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (const auto& [low, high] : extents.along[axis])
      least = std::min(least, low), greatest = std::max(greatest, high);
    const double farthest = std::max(std::abs(least), std::abs(greatest));
    int exponent;  // of a power of two that is above
    std::frexp(std::max({(greatest - least) / (255.0 - 3.0 * kRoom), 4e-6 * farthest, 1e-30}), &exponent);
    const double step = std::ldexp(1.0, exponent);
    node.exponent[axis] = static_cast<std::uint8_t>(std::min(exponent + 127, 254));
    node.origin[axis] = static_cast<float>(least - kRoom * step);
    for (std::size_t i = 0; i < extents.along[axis].size(); ++i) {
      const auto [low, high] = extents.along[axis][i];
      const auto steps = [&](double place) { return (place - static_cast<double>(node.origin[axis])) / step; };
      node.min[axis][i] = static_cast<std::uint8_t>(std::clamp(std::floor(steps(low) - 0.5 * kRoom), 0.0, 255.0));
      node.max[axis][i] = static_cast<std::uint8_t>(std::clamp(std::ceil(steps(high) + 0.5 * kRoom), 0.0, 255.0));
    }
  }
}

// Has boxes of leaves lean with their triangles, where that makes them thinner: else rays that pass a slope would look
// into most of its leaves.
class Lean {
 public:
  Lean(const GroupTriangles& triangles, const Bvh& bvh) : triangles_(triangles), bvh_(bvh) {}

  void operator()(std::span<const BvhBox> children, CompactNode& node, Extents& extents) const {
    glm::dvec3 normal(0.0);
    for (const BvhBox& child : children)
      if (BvhChild::is_leaf(child.child))
        for_corners(child.child, [&](const std::array<const glm::vec3*, 3>& corners) {
          normal += glm::dvec3(glm::cross(*corners[1] - *corners[0], *corners[2] - *corners[0]));
        });
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    if (!(size[axis] > 0.0)) return;
    node.leaning_axis = static_cast<std::uint8_t>(axis);
    const auto lean = [&](int other) {
      return static_cast<std::int8_t>(std::lround(127.0 * normal[other] / normal[axis]));
    };
    const std::int8_t leans[2] = {lean(next), lean(last)};
    const double shares[2] = {leans[0] / 128.0, leans[1] / 128.0};
    std::vector<std::array<double, 2>> leaning;
    double thickness = 0.0, upright = 0.0;
    for (std::size_t i = 0; i < children.size(); ++i) {
      leaning.push_back(extent_of(children[i], axis, shares));
      thickness += leaning.back()[1] - leaning.back()[0];
      upright += extents.along[axis][i][1] - extents.along[axis][i][0];
    }
    if (thickness >= upright) return;
    std::copy_n(leans, 2, node.lean);
    extents.along[axis] = std::move(leaning);
  }

 private:
  template <class Body>
  void for_corners(std::uint32_t leaf, const Body& body) const {
    for (std::uint32_t i = 0; i < BvhChild::count(leaf); ++i)
      body(triangles_.corners(bvh_.items[BvhChild::first(leaf) + i]));
  }

  // With room for rounding where rays are made to lean.
  std::array<double, 2> extent_of(const BvhBox& child, int axis, const double (&shares)[2]) const {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    std::array<double, 2> extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto add = [&](const glm::dvec3& point) {
      const double place = point[axis] + shares[0] * point[next] + shares[1] * point[last];
      extent = {std::min(extent[0], place), std::max(extent[1], place)};
    };
    if (BvhChild::is_leaf(child.child))
      for_corners(child.child, [&](const std::array<const glm::vec3*, 3>& corners) {
        for (const glm::vec3* corner : corners) add(*corner);
      });
    else
      for (int corner = 0; corner < 8; ++corner)
        add({(corner & 1) != 0 ? child.box.max.x : child.box.min.x,
             (corner & 2) != 0 ? child.box.max.y : child.box.min.y,
             (corner & 4) != 0 ? child.box.max.z : child.box.min.z});
    const glm::vec3 farthest = glm::max(glm::abs(bvh_.bounds.min), glm::abs(bvh_.bounds.max));
    const double room = 8e-7 * static_cast<double>(std::max({farthest.x, farthest.y, farthest.z}));
    return {extent[0] - room, extent[1] + room};
  }

  const GroupTriangles& triangles_;
  const Bvh& bvh_;
};

// Nodes of kWide children from binary ones, breadth first: so those that all rays pass lie side by side.
class Collapse {
 public:
  explicit Collapse(const Bvh& bvh) : bvh_(bvh), leaf_counts_(bvh.nodes.size()) {
    for (std::size_t node = bvh.nodes.size(); node-- > 0;)  // children stand behind their parents
      leaf_counts_[node] = leaf_count(bvh.nodes[node].children[0]) + leaf_count(bvh.nodes[node].children[1]);
  }

  // The nodes but for their boxes, and what is to be known of each box; add_leaf(BvhChild) gives the number of the next
  // leaf.
  template <class AddLeaf>
  void run(const AddLeaf& add_leaf) {
    nodes.resize(1);
    children_of.push_back({{bvh_.root, bvh_.bounds}});
    for (std::size_t at = 0; at < nodes.size(); ++at) {
      Children children = children_of[at];
      choose(children);
      const auto first_leaf = std::stable_partition(
          children.begin(), children.end(), [](const BvhBox& child) { return !BvhChild::is_leaf(child.child); });
      const auto node_count = static_cast<std::uint32_t>(first_leaf - children.begin());
      std::uint32_t leaf = 0;
      for (auto child = first_leaf; child != children.end(); ++child) {
        const std::uint32_t place = add_leaf(child->child);
        if (child == first_leaf) leaf = place;
      }
      nodes[at].nodes = static_cast<std::uint32_t>(nodes.size()) << kCompactCountBits | node_count;
      nodes[at].leaves = leaf << kCompactCountBits | static_cast<std::uint32_t>(children.end() - first_leaf);
      nodes.resize(nodes.size() + node_count);
      for (auto child = children.begin(); child != first_leaf; ++child) children_of.push_back({*child});
      children_of[at] = std::move(children);
    }
  }

  using Children = std::vector<BvhBox>;
  std::vector<CompactNode> nodes;
  std::vector<Children> children_of;  // of each node

 private:
  std::uint32_t leaf_count(std::uint32_t child) const { return BvhChild::is_leaf(child) ? 1 : leaf_counts_[child]; }

  void open(Children& children, std::size_t which) const {
    const BvhNode& node = bvh_.nodes[children[which].child];
    children[which] = {node.children[0], node.boxes[0]};
    children.push_back({node.children[1], node.boxes[1]});
  }

  // The largest boxes are opened first, but nothing that fills a node by itself; where there is room then, what fits.
  void choose(Children& children) const {
    while (children.size() < kWide) {
      const auto worth = [&](const BvhBox& child) {
        return leaf_count(child.child) > kWide || children.size() == 1 ? child.box.area() : -1.0f;
      };
      const auto best = std::max_element(children.begin(), children.end(),
                                         [&](const BvhBox& a, const BvhBox& b) { return worth(a) < worth(b); });
      if (worth(*best) < 0.0f || BvhChild::is_leaf(best->child)) break;
      open(children, static_cast<std::size_t>(best - children.begin()));
    }
    for (std::size_t i = 0; i < children.size(); ++i)
      if (children.size() + leaf_count(children[i].child) - 1 <= kWide)
        while (!BvhChild::is_leaf(children[i].child)) open(children, i);
  }

  const Bvh& bvh_;
  std::vector<std::uint32_t> leaf_counts_;  // below each node
};

}  // namespace

CompactMesh compact_mesh(const GeometryGroup& group, Bvh& bvh, ThreadPool& threads) {
  const GroupTriangles triangles(group);
  split_crowded_leaves(triangles, bvh, threads);
  Collapse collapse(bvh);
  std::vector<std::uint32_t> leaves;  // BvhChild
  collapse.run([&](std::uint32_t leaf) {
    leaves.push_back(leaf);
    return static_cast<std::uint32_t>(leaves.size() - 1);
  });
  CompactMesh mesh;
  mesh.bounds = bvh.bounds;
  mesh.first_triangles = triangles.firsts();
  mesh.nodes = std::move(collapse.nodes);
  const Lean lean(triangles, bvh);
  threads.parallel_for(static_cast<std::uint32_t>(mesh.nodes.size()), 64, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      Extents extents = extents_of(collapse.children_of[i]);
      if (i > 0 && (mesh.nodes[i].leaves & kCompactCountMask) > 0)
        lean(collapse.children_of[i], mesh.nodes[i], extents);
      set_boxes(mesh.nodes[i], extents);
    }
  });
  mesh.leaves.resize(leaves.size());
  threads.parallel_for(static_cast<std::uint32_t>(leaves.size()), 256, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) fill_leaf(mesh.leaves[i], triangles, items_of(bvh, leaves[i]));
  });
  return mesh;
}

std::vector<CompactNode> compact_top_level(std::span<const Box> boxes, std::vector<std::uint32_t>& items) {
  items.clear();
  const Bvh bvh = build_bvh(boxes, kInstanceLimits, nullptr);
  Collapse collapse(bvh);
  collapse.run([&](std::uint32_t leaf) {
    items.push_back(bvh.items[BvhChild::first(leaf)]);
    return static_cast<std::uint32_t>(items.size() - 1);
  });
  for (std::size_t i = 0; i < collapse.nodes.size(); ++i)
    set_boxes(collapse.nodes[i], extents_of(collapse.children_of[i]));
  return std::move(collapse.nodes);
}

}  // namespace lightwell
