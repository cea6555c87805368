#include "renderer/tracing/collapse_bvh.h"

#include <algorithm>
#include <array>
#include <limits>

#include "renderer/check.h"

namespace lightwell {
namespace {

struct Child {
  std::uint32_t child;  // BvhChild
  Box box;
};

void set_box(WideNode& node, int child, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    node.min[axis][child] = box.min[axis];
    node.max[axis][child] = box.max[axis];
  }
}

WideNode empty_node() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  WideNode node{};
  for (int child = 0; child < kWide; ++child) set_box(node, child, {glm::vec3(kInfinity), glm::vec3(-kInfinity)});
  return node;
}

class Collapse {
 public:
  Collapse(const Bvh& bvh, std::vector<WideNode>& nodes) : bvh_(bvh), nodes_(nodes) { emit({bvh.root, bvh.bounds}); }

 private:
  std::uint32_t emit(const Child& parent) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(empty_node());
    std::array<Child, kWide> children;
    const int count = open(parent, children);
    for (int i = 0; i < count; ++i) {
      const Child& child = children[static_cast<std::size_t>(i)];
      const bool is_leaf = BvhChild::is_leaf(child.child);
      LIGHTWELL_CHECK(!is_leaf || BvhChild::count(child.child) == 1);
      const std::uint32_t place = is_leaf ? bvh_.items[BvhChild::first(child.child)] | kWideLeafBit : emit(child);
      nodes_[node].child[i] = place;
      set_box(nodes_[node], i, child.box);
    }
    return node;
  }

  int open(const Child& parent, std::array<Child, kWide>& children) const {
    const auto area = [](const Child& child) { return BvhChild::is_leaf(child.child) ? -1.0f : child.box.area(); };
    children[0] = parent;
    int count = 1;
    while (count < kWide) {
      const auto largest = std::max_element(children.begin(), children.begin() + count,
                                            [&](const Child& a, const Child& b) { return area(a) < area(b); });
      if (BvhChild::is_leaf(largest->child)) break;
      const BvhNode& node = bvh_.nodes[largest->child];
      *largest = {node.children[0], node.boxes[0]};
      children[static_cast<std::size_t>(count++)] = {node.children[1], node.boxes[1]};
    }
    return count;
  }

  const Bvh& bvh_;
  std::vector<WideNode>& nodes_;
};

}  // namespace

std::vector<BvhRange> subtrees_of(const Bvh& bvh, std::uint32_t most_items) {
  std::vector<BvhRange> ranges(bvh.nodes.size());  // of all that is below a node, which lies side by side
  const auto range_of = [&](std::uint32_t child) {
    return BvhChild::is_leaf(child) ? BvhRange{BvhChild::first(child), BvhChild::count(child)} : ranges[child];
  };
  for (std::size_t node = ranges.size(); node-- > 0;) {  // children stand behind their parents
    const BvhRange left = range_of(bvh.nodes[node].children[0]), right = range_of(bvh.nodes[node].children[1]);
    ranges[node] = {std::min(left.first, right.first), left.count + right.count};
  }
  std::vector<BvhRange> subtrees;
  std::vector<std::uint32_t> stack{bvh.root};
  while (!stack.empty()) {
    const std::uint32_t child = stack.back();
    stack.pop_back();
    if (BvhChild::is_leaf(child) || range_of(child).count <= most_items)
      subtrees.push_back(range_of(child));
    else
      stack.insert(stack.end(), {bvh.nodes[child].children[1], bvh.nodes[child].children[0]});
  }
  return subtrees;
}

void collapse_bvh(const Bvh& bvh, std::vector<WideNode>& nodes) {
  nodes.clear();
  Collapse(bvh, nodes);
}

}  // namespace lightwell
