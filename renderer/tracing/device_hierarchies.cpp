#include "renderer/tracing/device_hierarchies.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "renderer/check.h"
#include "renderer/tracing/bindings.glsl"
#include "renderer/tracing/upload_if_changed.h"

namespace lightwell {
namespace {

constexpr std::uint64_t kFramesUntilDropped = 120;
constexpr float kRefitCostLimit = 1.5f;  // growth of the expected cost after which a refitted hierarchy is rebuilt
constexpr BvhLimits kBottomLimits{4, TRACE_BOTTOM_LEVELS};
constexpr BvhLimits kTopLimits{1, TRACE_TOP_LEVELS};

// std430, 48 bytes; `triangle_words` in trace.comp.
struct DeviceTriangle {
  glm::vec3 a;
  std::uint32_t triangle;  // in its primitive
  glm::vec3 b;
  std::uint32_t primitive;  // in its group
  glm::vec3 c;
  std::uint32_t padding;
};
static_assert(sizeof(DeviceTriangle) == 48);

std::vector<DeviceTriangle> triangles_of(const GeometryGroup& group) {
  std::vector<DeviceTriangle> triangles;
  for_triangles(group, [&](std::uint32_t primitive, std::uint32_t triangle, const std::array<glm::vec3, 3>& corners) {
    triangles.push_back({corners[0], triangle, corners[1], primitive, corners[2], 0});
  });
  return triangles;
}

std::vector<Box> boxes_of(const std::vector<DeviceTriangle>& triangles) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const glm::vec3& corner : {triangles[i].a, triangles[i].b, triangles[i].c}) boxes[i].add(corner);
  return boxes;
}

// The child as it stands in shared buffers.
std::uint32_t moved(std::uint32_t child, std::uint32_t first_node, std::uint32_t first_item) {
  return child + (BvhChild::is_leaf(child) ? first_item : first_node);
}

std::vector<BvhNode> moved(std::vector<BvhNode> nodes, std::uint32_t first_node, std::uint32_t first_item) {
  for (BvhNode& node : nodes)
    for (std::uint32_t& child : node.children) child = moved(child, first_node, first_item);
  return nodes;
}

// Whether the device has made the positions that it is to be traced at.
bool is_on_device(const GeometryGroup& group, const TraceScene& scene) {
  return scene.device_positions.buffer && !group.deformed->is_given();
}

Box in_world(const Box& box, const glm::mat4& world_from_object) {
  Box world;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                      corner & 4 ? box.max.z : box.min.z};
    world.add(glm::vec3(world_from_object * glm::vec4(p, 1.0f)));
  }
  // Room for the rounding of the ray's way into the group's space and of the corners' way out of it.
  const glm::vec3 slack = 1e-6f * glm::max(glm::abs(world.min), glm::abs(world.max));
  return {world.min - slack, world.max + slack};
}

}  // namespace

DeviceHierarchies::DeviceHierarchies(gl::ShaderLibrary& shaders)
    : nodes_("hierarchy nodes", sizeof(BvhNode)),
      triangles_("hierarchy triangles", sizeof(DeviceTriangle)),
      places_("triangle places", sizeof(std::uint32_t)),
      shaders_(shaders),
      group_buffer_("geometry groups", 0),
      instance_buffer_("instances of hierarchies", 0) {}

void DeviceHierarchies::update(const TraceScene& scene) {
  ++frame_;
  const std::vector<GeometryGroup> groups =
      group_instances(scene.instances, coverage_.update(scene, kFramesUntilDropped));
  std::vector<const BottomLevel*> levels;
  levels.reserve(groups.size());
  for (const GeometryGroup& group : groups) levels.push_back(&bottom_level(group, scene));
  build_top_level(groups, levels, scene.instances.size());
  drop_unused();
}

void DeviceHierarchies::bind() const {
  nodes_.bind_storage(TRACE_BINDING_NODES);
  triangles_.bind_storage(TRACE_BINDING_TRIANGLES);
  group_buffer_.bind_storage(TRACE_BINDING_GROUPS);
  coverage_.bind();
}

void DeviceHierarchies::bind_places() const {
  places_.bind_storage(TRACE_BINDING_PLACES);
  instance_buffer_.bind_storage(TRACE_BINDING_INSTANCES);
}

std::uint64_t DeviceHierarchies::memory_bytes() const {
  return nodes_.size_bytes() + triangles_.size_bytes() + places_.size_bytes() + coverage_.memory_bytes() +
         group_buffer_.size_bytes() + instance_buffer_.size_bytes() +
         (device_refit_ ? device_refit_->memory_bytes() : 0);
}

const DeviceHierarchies::BottomLevel& DeviceHierarchies::bottom_level(const GeometryGroup& group,
                                                                      const TraceScene& scene) {
  const auto known = bottom_levels_.find(group.key);
  if (known == bottom_levels_.end()) {
    auto built = std::make_unique<BottomLevel>();
    build(*built, group, scene);
    built->last_used = frame_;
    return *bottom_levels_.emplace(group.key, std::move(built)).first->second;
  }
  BottomLevel& level = *known->second;
  if (!same_shape(group.deformed, level.shape)) refit(level, group, scene);
  level.last_used = frame_;
  return level;
}

void DeviceHierarchies::build(BottomLevel& level, const GeometryGroup& group, const TraceScene& scene) {
  level.primitives.clear();
  for (std::uint32_t i = 0; i < group.key.primitives.size(); ++i)
    level.primitives.push_back(scene.instances[group.first_instance + i].primitive);
  const std::vector<Box> boxes = boxes_of(triangles_of(group));
  Bvh bvh = build_bvh(boxes, kBottomLimits, &threads_);
  level.nodes = nodes_.allocate(static_cast<std::uint32_t>(bvh.nodes.size()));
  level.triangles = triangles_.allocate(static_cast<std::uint32_t>(boxes.size()));
  level.places = places_.allocate(static_cast<std::uint32_t>(boxes.size()));
  upload(level, bvh, group);
  level.root = moved(bvh.root, level.nodes.first(), level.triangles.first());
  level.bounds = bvh.bounds;
  level.shape = group.deformed;
  if (!group.deformed) return;
  level.built_cost = expected_cost(bvh);
  if (!is_on_device(group, scene)) {
    level.bvh = std::move(bvh);
    return;
  }
  if (!device_refit_) device_refit_.emplace(shaders_);
  level.plan = device_refit_->plan(bvh, *level.primitives.front(), level.nodes.first());
}

void DeviceHierarchies::refit(BottomLevel& level, const GeometryGroup& group, const TraceScene& scene) {
  if (!is_on_device(group, scene) && level.bvh)
    refit_by_processor(level, group);
  else if (is_on_device(group, scene) && level.plan &&
           device_refit_->cost(*level.plan) <= kRefitCostLimit * level.built_cost)
    refit_on_device(level, group, scene);
  else
    build(level, group, scene);
}

void DeviceHierarchies::refit_by_processor(BottomLevel& level, const GeometryGroup& group) {
  const std::vector<Box> boxes = boxes_of(triangles_of(group));
  refit_bvh(*level.bvh, boxes);
  if (expected_cost(*level.bvh) > kRefitCostLimit * level.built_cost) {
    level.bvh = build_bvh(boxes, kBottomLimits, &threads_);
    level.built_cost = expected_cost(*level.bvh);
    level.nodes = nodes_.allocate(static_cast<std::uint32_t>(level.bvh->nodes.size()));
  }
  upload(level, *level.bvh, group);
  level.root = moved(level.bvh->root, level.nodes.first(), level.triangles.first());
  level.bounds = level.bvh->bounds;
  level.shape = group.deformed;
}

void DeviceHierarchies::refit_on_device(BottomLevel& level, const GeometryGroup& group, const TraceScene& scene) {
  device_refit_->run(
      *level.plan,
      {nodes_, triangles_, level.nodes.first(), level.nodes.count(), level.triangles.first(), level.triangles.count()},
      *scene.device_positions.buffer, scene.device_positions.first[group.first_instance]);
  const Bounds& bounds = group.deformed->bounds();
  const glm::vec3 slack = 1e-5f * (bounds.max - bounds.min);  // the device rounds otherwise
  level.bounds = {bounds.min - slack, bounds.max + slack};
  level.shape = group.deformed;
}

void DeviceHierarchies::upload(const BottomLevel& level, const Bvh& bvh, const GeometryGroup& group) {
  LIGHTWELL_CHECK_OP(level.triangles.first() + level.triangles.count() + BvhChild::kMostLeafItems, <=,
                     BvhChild::kMostItems);
  const std::vector<BvhNode> nodes = moved(bvh.nodes, level.nodes.first(), level.triangles.first());
  nodes_.upload(level.nodes, std::span<const BvhNode>(nodes));
  const std::vector<DeviceTriangle> triangles = triangles_of(group);
  std::vector<DeviceTriangle> ordered;
  ordered.reserve(triangles.size());
  std::vector<std::uint32_t> places(triangles.size());
  for (const std::uint32_t item : bvh.items) {
    places[item] = level.triangles.first() + static_cast<std::uint32_t>(ordered.size());
    ordered.push_back(triangles[item]);
  }
  triangles_.upload(level.triangles, std::span<const DeviceTriangle>(ordered));
  places_.upload(level.places, std::span<const std::uint32_t>(places));
}

// `order[i]` is the group that stands at place i in the group buffer.
std::vector<DeviceInstance> DeviceHierarchies::find_instances(const std::vector<GeometryGroup>& groups,
                                                              const std::vector<const BottomLevel*>& levels,
                                                              const std::vector<std::uint32_t>& order,
                                                              std::size_t count) const {
  std::vector<DeviceInstance> found(count, DeviceInstance{0, 0});
  for (std::uint32_t place = 0; place < order.size(); ++place) {
    const GeometryGroup& group = groups[order[place]];
    std::uint32_t first = levels[order[place]]->places.first();
    for (std::size_t i = 0; i < group.key.primitives.size(); ++i) {
      found[group.first_instance + i] = {place, first};
      first += static_cast<std::uint32_t>(group.key.primitives[i]->indices.size() / 3);
    }
  }
  return found;
}

void DeviceHierarchies::build_top_level(const std::vector<GeometryGroup>& groups,
                                        const std::vector<const BottomLevel*>& levels, std::size_t instance_count) {
  if (groups.empty()) {
    top_root_ = kNothing;
    groups_.clear();
    return;
  }
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < groups.size(); ++i)
    boxes.push_back(in_world(levels[i]->bounds, groups[i].world_from_object));
  const Bvh top = build_bvh(boxes, kTopLimits, nullptr);

  const auto count = static_cast<std::uint32_t>(top.nodes.size());
  if (count > top_range_.count()) {
    top_range_ = nodes_.allocate(std::bit_ceil(count));
    top_nodes_.clear();
  }
  std::vector<BvhNode> nodes = moved(top.nodes, top_range_.first(), 0);
  if (nodes.size() != top_nodes_.size() ||
      std::memcmp(nodes.data(), top_nodes_.data(), nodes.size() * sizeof(BvhNode)) != 0) {
    nodes_.upload(top_range_, std::span<const BvhNode>(nodes));
    top_nodes_ = std::move(nodes);
  }
  top_root_ = moved(top.root, top_range_.first(), 0);

  std::vector<DeviceGroup> records;
  for (const std::uint32_t item : top.items) {
    const glm::mat4 rows = glm::transpose(glm::inverse(groups[item].world_from_object));
    records.push_back({{rows[0], rows[1], rows[2]},
                       levels[item]->root,
                       groups[item].first_instance,
                       levels[item]->triangles.count() | (groups[item].key.filtered ? DeviceGroup::kNeedsCoverage : 0u),
                       levels[item]->triangles.first()});
  }
  upload_if_changed(group_buffer_, groups_, std::move(records));
  upload_if_changed(instance_buffer_, instances_, find_instances(groups, levels, top.items, instance_count));
}

void DeviceHierarchies::drop_unused() {
  const auto is_unused = [&](std::uint64_t last_used) { return last_used + kFramesUntilDropped < frame_; };
  std::erase_if(bottom_levels_, [&](const auto& entry) { return is_unused(entry.second->last_used); });
}

}  // namespace lightwell
