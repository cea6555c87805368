#include "renderer/tracing/device_hierarchies.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "renderer/check.h"
#include "renderer/tracing/bindings.glsl"

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

// Replaces the buffer's contents if they differ from what was uploaded last.
template <class T>
void upload_if_changed(gl::Buffer& buffer, std::vector<T>& uploaded, std::vector<T> wanted) {
  const std::size_t size_bytes = wanted.size() * sizeof(T);
  if (wanted.size() == uploaded.size() &&
      (wanted.empty() || std::memcmp(wanted.data(), uploaded.data(), size_bytes) == 0))
    return;
  uploaded = std::move(wanted);
  buffer.reserve(std::bit_ceil(std::uint64_t{size_bytes}));
  buffer.upload(std::span<const T>(uploaded));
}

}  // namespace

DeviceHierarchies::DeviceHierarchies()
    : nodes_("hierarchy nodes", sizeof(BvhNode)),
      triangles_("hierarchy triangles", sizeof(DeviceTriangle)),
      places_("triangle places", sizeof(std::uint32_t)),
      corner_uvs_("texture coordinates for coverage", sizeof(glm::vec2)),
      alpha_("alpha planes for coverage", sizeof(std::uint32_t)),
      group_buffer_("geometry groups", 0),
      coverage_buffer_("coverage tests", 0),
      instance_buffer_("instances of hierarchies", 0) {}

void DeviceHierarchies::update(const TraceScene& scene) {
  LIGHTWELL_CHECK_OP(scene.instances.size(), ==, scene.coverage.size());
  ++frame_;
  std::vector<bool> filtered;
  update_coverage(scene, filtered);
  const std::vector<GeometryGroup> groups = group_instances(scene.instances, filtered);
  std::vector<const BottomLevel*> levels;
  levels.reserve(groups.size());
  for (const GeometryGroup& group : groups) levels.push_back(&bottom_level(group, scene.instances));
  build_top_level(groups, levels, scene.instances.size());
  drop_unused();
}

void DeviceHierarchies::bind() const {
  nodes_.bind_storage(TRACE_BINDING_NODES);
  triangles_.bind_storage(TRACE_BINDING_TRIANGLES);
  group_buffer_.bind_storage(TRACE_BINDING_GROUPS);
  coverage_buffer_.bind_storage(TRACE_BINDING_COVERAGE);
  corner_uvs_.bind_storage(TRACE_BINDING_CORNER_UVS);
  alpha_.bind_storage(TRACE_BINDING_ALPHA);
}

void DeviceHierarchies::bind_places() const {
  places_.bind_storage(TRACE_BINDING_PLACES);
  instance_buffer_.bind_storage(TRACE_BINDING_INSTANCES);
}

std::uint64_t DeviceHierarchies::memory_bytes() const {
  return nodes_.size_bytes() + triangles_.size_bytes() + places_.size_bytes() + corner_uvs_.size_bytes() +
         alpha_.size_bytes() + group_buffer_.size_bytes() + coverage_buffer_.size_bytes() +
         instance_buffer_.size_bytes();
}

const DeviceHierarchies::BottomLevel& DeviceHierarchies::bottom_level(const GeometryGroup& group,
                                                                      std::span<const Instance> instances) {
  const auto known = bottom_levels_.find(group.key);
  if (known == bottom_levels_.end()) {
    auto built = std::make_unique<BottomLevel>();
    build(*built, group, instances);
    built->last_used = frame_;
    return *bottom_levels_.emplace(group.key, std::move(built)).first->second;
  }
  BottomLevel& level = *known->second;
  if (!same_shape(group.deformed, level.shape)) refit(level, group);
  level.last_used = frame_;
  return level;
}

void DeviceHierarchies::build(BottomLevel& level, const GeometryGroup& group, std::span<const Instance> instances) {
  for (std::uint32_t i = 0; i < group.key.primitives.size(); ++i)
    level.primitives.push_back(instances[group.first_instance + i].primitive);
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
  level.bvh = std::move(bvh);
}

void DeviceHierarchies::refit(BottomLevel& level, const GeometryGroup& group) {
  const std::vector<Box> boxes = boxes_of(triangles_of(group));
  refit_bvh(level.bvh, boxes);
  if (expected_cost(level.bvh) > kRefitCostLimit * level.built_cost) {
    level.bvh = build_bvh(boxes, kBottomLimits, &threads_);
    level.built_cost = expected_cost(level.bvh);
    level.nodes = nodes_.allocate(static_cast<std::uint32_t>(level.bvh.nodes.size()));
  }
  upload(level, level.bvh, group);
  level.root = moved(level.bvh.root, level.nodes.first(), level.triangles.first());
  level.bounds = level.bvh.bounds;
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

void DeviceHierarchies::update_coverage(const TraceScene& scene, std::vector<bool>& filtered) {
  std::vector<DeviceCoverage> tests;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const CoverageTest test = prepare_coverage(scene.coverage[i], *scene.instances[i].primitive, alpha_ranges_);
    filtered.push_back(test.outcome != CoverageTest::Outcome::kAlwaysHit);
    tests.push_back(device_coverage(test, scene, i));
  }
  needs_coverage_ = std::find(filtered.begin(), filtered.end(), true) != filtered.end();
  if (needs_coverage_) upload_if_changed(coverage_buffer_, coverage_, std::move(tests));
}

DeviceCoverage DeviceHierarchies::device_coverage(const CoverageTest& test, const TraceScene& scene,
                                                  std::size_t instance) {
  DeviceCoverage packed{};
  packed.outcome = static_cast<std::uint32_t>(test.outcome);
  packed.min_texel = test.min_texel;
  packed.blend_factor = test.blend_factor;
  packed.wraps = static_cast<std::uint32_t>(test.wrap_s) | static_cast<std::uint32_t>(test.wrap_t) << 8;
  packed.u_row = glm::vec4(test.u_row, 0.0f);
  packed.v_row = glm::vec4(test.v_row, 0.0f);
  const bool reads_image =
      test.outcome == CoverageTest::Outcome::kMask || test.outcome == CoverageTest::Outcome::kBlend;
  if (!test.image || !reads_image) return packed;
  packed.first_texel = first_texel(scene.coverage[instance].image);
  packed.width_px = static_cast<std::uint32_t>(test.image->size_px.x);
  packed.height_px = static_cast<std::uint32_t>(test.image->size_px.y);
  packed.first_corner = first_corner(scene.instances[instance].primitive, test.uv_set);
  return packed;
}

std::uint32_t DeviceHierarchies::first_corner(const std::shared_ptr<const Primitive>& primitive, int uv_set) {
  CornerUvs& corners = corners_[{primitive.get(), uv_set}];
  corners.last_used = frame_;
  if (corners.primitive) return corners.range.first();
  const auto& uvs = uv_set == 0 ? primitive->uv0 : primitive->uv1;
  std::vector<glm::vec2> unrolled;
  unrolled.reserve(primitive->indices.size());
  for (const std::uint32_t index : primitive->indices) unrolled.push_back(uvs[index]);
  corners.range = corner_uvs_.allocate(static_cast<std::uint32_t>(unrolled.size()));
  corner_uvs_.upload(corners.range, std::span<const glm::vec2>(unrolled));
  corners.primitive = primitive;
  return corners.range.first();
}

std::uint32_t DeviceHierarchies::first_texel(const std::shared_ptr<const Image>& image) {
  AlphaPlane& plane = planes_[image.get()];
  plane.last_used = frame_;
  if (!plane.image) {
    std::vector<std::uint32_t> words((image->rgba.size() / 4 + 3) / 4);
    for (std::size_t texel = 0; texel < image->rgba.size() / 4; ++texel)
      words[texel / 4] |= std::uint32_t{image->rgba[4 * texel + 3]} << (8 * (texel % 4));
    plane.words = alpha_.allocate(static_cast<std::uint32_t>(words.size()));
    alpha_.upload(plane.words, std::span<const std::uint32_t>(words));
    plane.image = image;
  }
  return 4 * plane.words.first();
}

void DeviceHierarchies::drop_unused() {
  const auto is_unused = [&](std::uint64_t last_used) { return last_used + kFramesUntilDropped < frame_; };
  std::erase_if(bottom_levels_, [&](const auto& entry) { return is_unused(entry.second->last_used); });
  std::erase_if(corners_, [&](const auto& entry) { return is_unused(entry.second.last_used); });
  std::erase_if(planes_, [&](const auto& entry) { return is_unused(entry.second.last_used); });
  alpha_ranges_.drop_unused();
}

}  // namespace lightwell
