#include "renderer/tracing/world_hierarchy.h"

#include <algorithm>
#include <atomic>

namespace lightwell {
namespace {

constexpr float kRefitAreaLimit = 2.0f;  // growth of the leaves' area after which a deformed group is sorted anew
constexpr BvhLimits kTriangleLimits{4, 40}, kLeafLimits{1, 40};

void set_triangle(WideLeaf& leaf, int place, const std::array<glm::vec3, 3>& corners_ws) {
  const glm::vec3 to_second = corners_ws[1] - corners_ws[0], to_third = corners_ws[2] - corners_ws[0];
  const glm::vec3 normal = glm::cross(to_second, to_third);
  for (int axis = 0; axis < 3; ++axis) {
    leaf.corner[axis][place] = corners_ws[0][axis];
    leaf.to_second[axis][place] = to_second[axis];
    leaf.to_third[axis][place] = to_third[axis];
    leaf.normal[axis][place] = normal[axis];
  }
}

Box box_of(const WideLeaf& leaf, std::uint32_t count) {
  const auto vector = [](const float(&rows)[3][kWide], std::uint32_t i) {
    return glm::vec3(rows[0][i], rows[1][i], rows[2][i]);
  };
  Box box;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 corner = vector(leaf.corner, i);
    box.add(corner);
    box.add(corner + vector(leaf.to_second, i));
    box.add(corner + vector(leaf.to_third, i));
  }
  // Room for rounding, and for hits that lie by as much outside of their triangle.
  const glm::vec3 slack = 2e-6f * glm::max(glm::abs(box.min), glm::abs(box.max));
  return {box.min - slack, box.max + slack};
}

std::size_t triangle_count(const std::vector<GeometryGroup>& groups) {
  std::size_t count = 0;
  for (const GeometryGroup& group : groups)
    for (const Primitive* primitive : group.key.primitives) count += primitive->indices.size() / 3;
  return count;
}

bool same_layout(const std::vector<GeometryGroup>& a, const std::vector<GeometryGroup>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const GeometryGroup& one, const GeometryGroup& other) {
    return one.key == other.key && one.first_instance == other.first_instance;
  });
}

}  // namespace

const WideHierarchy* WorldHierarchy::update(const TraceScene& scene, ThreadPool& threads) {
  const auto needs_coverage = [](const Coverage& coverage) { return coverage.mode != AlphaMode::kOpaque; };
  if (std::any_of(scene.coverage.begin(), scene.coverage.end(), needs_coverage)) return nullptr;
  std::vector<GeometryGroup> groups =
      group_instances(scene.instances, std::vector<bool>(scene.instances.size(), false));
  if (groups.empty() || triangle_count(groups) > kMostTriangles) return nullptr;
  if (same_layout(groups, groups_))
    groups_ = std::move(groups);
  else
    lay_out(std::move(groups), scene.instances);
  std::atomic<bool> moved = false;
  threads.parallel_for(static_cast<std::uint32_t>(groups_.size()), 1, [&](std::uint32_t i, std::uint32_t) {
    if (place(groups_[i], placed_[i])) moved = true;
  });
  if (moved) collapse_bvh(build_bvh(boxes_, kLeafLimits, nullptr), nodes_);
  hierarchy_ = {nodes_.data(), leaves_.data(), 0};
  forget_degraded();
  return &hierarchy_;
}

std::uint64_t WorldHierarchy::memory_bytes() const {
  return nodes_.capacity() * sizeof(WideNode) + leaves_.capacity() * sizeof(WideLeaf);
}

std::shared_ptr<const WorldHierarchy::Topology> WorldHierarchy::topology_of(const GeometryGroup& group,
                                                                            std::span<const Instance> instances) const {
  const auto known = topologies_.find(group.key);
  if (known != topologies_.end()) return known->second;
  std::vector<Box> boxes;
  for_triangles(group, [&](std::uint32_t, std::uint32_t, const std::array<glm::vec3, 3>& corners) {
    Box& box = boxes.emplace_back();
    for (const glm::vec3& corner : corners) box.add(corner);
  });
  Bvh bvh = build_bvh(boxes, kTriangleLimits, nullptr);
  auto topology = std::make_shared<Topology>();
  for (std::size_t i = 0; i < group.key.primitives.size(); ++i)
    topology->primitives.push_back(instances[group.first_instance + i].primitive);
  topology->leaves = subtrees_of(bvh, kWide);
  topology->items = std::move(bvh.items);
  return topology;
}

// Topologies that no group has any more are forgotten.
void WorldHierarchy::lay_out(std::vector<GeometryGroup> groups, std::span<const Instance> instances) {
  groups_ = std::move(groups);
  placed_.clear();
  std::uint32_t leaves = 0;
  std::map<GeometryKey, std::shared_ptr<const Topology>> used;
  for (const GeometryGroup& group : groups_) {
    std::shared_ptr<const Topology>& topology = used[group.key];
    if (!topology) topology = topology_of(group, instances);
    Placed& placed = placed_.emplace_back();
    placed.topology = topology;
    placed.first_leaf = leaves;
    leaves += static_cast<std::uint32_t>(topology->leaves.size());
  }
  leaves_.assign(leaves, WideLeaf{});
  boxes_.assign(leaves, Box{});
  topologies_ = std::move(used);
}

// False where it is already.
bool WorldHierarchy::place(const GeometryGroup& group, Placed& placed) {
  if (placed.world_from_object == group.world_from_object && same_shape(placed.shape, group.deformed)) return false;
  placed.world_from_object = group.world_from_object;
  placed.shape = group.deformed;
  place_triangles(group, placed);
  fit_boxes(placed);
  return true;
}

void WorldHierarchy::place_triangles(const GeometryGroup& group, const Placed& placed) {
  std::vector<std::uint32_t> places(placed.topology->items.size());  // of triangles: leaf * kWide + which
  for (std::uint32_t leaf = 0; leaf < placed.topology->leaves.size(); ++leaf) {
    const auto [first, count] = placed.topology->leaves[leaf];
    for (std::uint32_t i = 0; i < count; ++i)
      places[placed.topology->items[first + i]] = (placed.first_leaf + leaf) * kWide + i;
  }
  std::size_t item = 0;
  for_triangles(group, [&](std::uint32_t primitive, std::uint32_t triangle, std::array<glm::vec3, 3> corners) {
    for (glm::vec3& corner : corners) corner = glm::vec3(group.world_from_object * glm::vec4(corner, 1.0f));
    const std::uint32_t place = places[item++];
    WideLeaf& leaf = leaves_[place / kWide];
    set_triangle(leaf, static_cast<int>(place % kWide), corners);
    leaf.instance[place % kWide] = group.first_instance + primitive;
    leaf.triangle[place % kWide] = triangle;
  });
}

void WorldHierarchy::fit_boxes(Placed& placed) {
  placed.area_m2 = 0.0f;
  for (std::uint32_t leaf = 0; leaf < placed.topology->leaves.size(); ++leaf) {
    Box& box = boxes_[placed.first_leaf + leaf];
    box = box_of(leaves_[placed.first_leaf + leaf], placed.topology->leaves[leaf].count);
    placed.area_m2 += box.area();
  }
  if (placed.built_area_m2 == 0.0f) placed.built_area_m2 = placed.area_m2;
}

// Deformed geometry keeps its order until it has grown out of it; then the next frame sorts it anew.
void WorldHierarchy::forget_degraded() {
  bool any = false;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    if (!placed_[i].shape || placed_[i].area_m2 <= kRefitAreaLimit * placed_[i].built_area_m2) continue;
    topologies_.erase(groups_[i].key);
    any = true;
  }
  if (any) groups_.clear();
}

}  // namespace lightwell
