#include "renderer/passes/device_geometry.h"

#include <algorithm>

#include "renderer/gl/texel_limit.h"
#include "renderer/passes/device_types.h"

namespace lightwell {

namespace {

constexpr std::uint64_t kTexelBytes = 16;

bool same_task(const DeformTask& a, const DeformTask& b) {
  return a.primitive == b.primitive && a.first_vertex == b.first_vertex && a.first_triangle == b.first_triangle &&
         same_shape(a.shape, b.shape);
}

}  // namespace

DeviceGeometry::DeviceGeometry(std::vector<std::shared_ptr<const Primitive>> primitives, gl::BufferUse use)
    : primitives_(std::move(primitives)) {
  std::uint64_t vertices = 0, indices = 0;
  for (const auto& primitive : primitives_) {
    first_vertex_.push_back(static_cast<std::uint32_t>(vertices));
    first_index_.push_back(static_cast<std::uint32_t>(indices));
    vertices += primitive->positions.size();
    indices += primitive->indices.size();
  }
  gl::check_texels(vertices * sizeof(DeviceVertex), kTexelBytes, "vertices");
  gl::check_texels(indices / 3 * sizeof(DeviceTriangle), kTexelBytes, "triangles");
  rigid_vertices_ = static_cast<std::uint32_t>(vertices);
  rigid_triangles_ = static_cast<std::uint32_t>(indices / 3);
  indices_ = gl::Buffer("indices", indices * sizeof(std::uint32_t));
  for (std::size_t i = 0; i < primitives_.size(); ++i)
    indices_.upload(std::span<const std::uint32_t>(primitives_[i]->indices), first_index_[i] * sizeof(std::uint32_t));
  positions_ = gl::Buffer("positions", vertices * sizeof(glm::vec3), use);
  vertices_ = gl::Buffer("vertices", vertices * sizeof(DeviceVertex));
  triangles_ = gl::Buffer("triangles", indices / 3 * sizeof(DeviceTriangle), use);
  upload_rigid();
}

std::size_t DeviceGeometry::number_of(const std::shared_ptr<const Primitive>& primitive) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(primitives_, primitive) - primitives_.begin());
}

void DeviceGeometry::upload_rigid() {
  for (std::size_t i = 0; i < primitives_.size(); ++i) {
    positions_.upload(std::span<const glm::vec3>(primitives_[i]->positions), first_vertex_[i] * sizeof(glm::vec3));
    const std::vector<DeviceVertex> packed = pack_vertices(*primitives_[i]);
    vertices_.upload(std::span<const DeviceVertex>(packed), first_vertex_[i] * sizeof(DeviceVertex));
    const std::vector<DeviceTriangle> triangles = pack_triangles(*primitives_[i]);
    triangles_.upload(std::span<const DeviceTriangle>(triangles), first_index_[i] / 3 * sizeof(DeviceTriangle));
  }
}

void DeviceGeometry::reserve_deformed(std::uint32_t vertices, std::uint32_t triangles) {
  const std::uint64_t all_vertices = std::uint64_t{rigid_vertices_} + vertices;
  const std::uint64_t all_triangles = std::uint64_t{rigid_triangles_} + triangles;
  gl::check_texels(all_vertices * sizeof(DeviceVertex), kTexelBytes, "deformed vertices");
  gl::check_texels(all_triangles * sizeof(DeviceTriangle), kTexelBytes, "deformed triangles");
  const bool moved[] = {positions_.reserve(all_vertices * sizeof(glm::vec3)),
                        vertices_.reserve(all_vertices * sizeof(DeviceVertex)),
                        triangles_.reserve(all_triangles * sizeof(DeviceTriangle))};
  if (moved[0] || moved[1] || moved[2]) {
    upload_rigid();
    deformed_.clear();
  }
  if (!deformation_sources_) deformation_sources_.emplace(primitives_);
}

bool DeviceGeometry::becomes(const std::vector<DeformTask>& tasks) {
  if (std::ranges::equal(deformed_, tasks, same_task)) return true;
  deformed_ = tasks;
  return false;
}

}  // namespace lightwell
