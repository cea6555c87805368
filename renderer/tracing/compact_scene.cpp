#include "renderer/tracing/compact_scene.h"

#include <algorithm>
#include <numeric>

namespace lightwell {
namespace {

std::size_t triangle_count(const GeometryGroup& group) {
  return std::transform_reduce(group.key.primitives.begin(), group.key.primitives.end(), std::size_t{0}, std::plus<>(),
                               [](const Primitive* primitive) { return primitive->indices.size() / 3; });
}

Box in_world(const Box& box, const glm::mat4& world_from_object) {
  Box world;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                          (corner & 4) != 0 ? box.max.z : box.min.z);
    world.add(glm::vec3(world_from_object * glm::vec4(point, 1.0f)));
  }
  const glm::vec3 slack = 2e-6f * glm::max(glm::abs(world.min), glm::abs(world.max));  // for rounding
  return {world.min - slack, world.max + slack};
}

CompactInstance placed(const GeometryGroup& group, const CompactMesh& mesh) {
  const glm::mat4 object_from_world = glm::inverse(group.world_from_object);
  CompactInstance instance;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) instance.object_from_world[row][column] = object_from_world[column][row];
  instance.nodes = mesh.nodes.data();
  instance.leaves = mesh.leaves.data();
  instance.first_triangles = mesh.first_triangles.data();
  instance.primitive_count = static_cast<std::uint32_t>(mesh.first_triangles.size());
  instance.first_instance = group.first_instance;
  return instance;
}

}  // namespace

const CompactHierarchy* CompactScene::update(const TraceScene& scene, ThreadPool& threads, const BuildBvh& build) {
  const auto needs_coverage = [](const Coverage& coverage) { return coverage.mode != AlphaMode::kOpaque; };
  const auto is_unfit = [](const GeometryGroup& group) {
    return group.deformed || triangle_count(group) >= BvhChild::kMostItems;
  };
  if (std::any_of(scene.coverage.begin(), scene.coverage.end(), needs_coverage)) return nullptr;
  const std::vector<GeometryGroup> groups =
      group_instances(scene.instances, std::vector<bool>(scene.instances.size(), false));
  if (groups.empty() || std::any_of(groups.begin(), groups.end(), is_unfit)) return nullptr;

  std::map<GeometryKey, std::shared_ptr<const Mesh>> used;
  std::vector<Box> boxes;
  std::vector<CompactInstance> instances;
  for (const GeometryGroup& group : groups) {
    std::shared_ptr<const Mesh>& mesh = used[group.key];
    if (!mesh) mesh = mesh_of(group, scene.instances, threads, build);
    boxes.push_back(in_world(mesh->packed.bounds, group.world_from_object));
    instances.push_back(placed(group, mesh->packed));
  }
  meshes_ = std::move(used);
  std::vector<std::uint32_t> order;
  nodes_ = compact_top_level(boxes, order);
  instances_.clear();
  for (const std::uint32_t i : order) instances_.push_back(instances[i]);
  hierarchy_ = {nodes_.data(), instances_.data(), static_cast<std::uint32_t>(instances_.size())};
  return &hierarchy_;
}

std::uint64_t CompactScene::memory_bytes() const {
  std::uint64_t bytes = nodes_.capacity() * sizeof(CompactNode) + instances_.capacity() * sizeof(CompactInstance);
  for (const auto& [key, mesh] : meshes_)
    bytes += mesh->packed.nodes.capacity() * sizeof(CompactNode) + mesh->packed.leaves.capacity() * sizeof(CompactLeaf);
  return bytes;
}

std::shared_ptr<const CompactScene::Mesh> CompactScene::mesh_of(const GeometryGroup& group,
                                                                std::span<const Instance> instances,
                                                                ThreadPool& threads, const BuildBvh& build) const {
  const auto known = meshes_.find(group.key);
  if (known != meshes_.end()) return known->second;
  std::vector<Box> boxes;
  boxes.reserve(triangle_count(group));
  for_triangles(group, [&](std::uint32_t, std::uint32_t, const std::array<glm::vec3, 3>& corners) {
    Box& box = boxes.emplace_back();
    for (const glm::vec3& corner : corners) box.add(corner);
  });
  Bvh bvh = build(boxes);
  auto mesh = std::make_shared<Mesh>();
  for (std::size_t i = 0; i < group.key.primitives.size(); ++i)
    mesh->primitives.push_back(instances[group.first_instance + i].primitive);
  mesh->packed = compact_mesh(group, bvh, threads);
  return mesh;
}

}  // namespace lightwell
