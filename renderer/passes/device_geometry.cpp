#include "renderer/passes/device_geometry.h"

#include <stdexcept>
#include <string>

#include "renderer/passes/device_types.h"

namespace lightwell {

namespace {

constexpr std::uint64_t kTexelBytes = 16;

void check_texels(std::uint64_t bytes, const char* what) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  if (bytes / kTexelBytes > static_cast<std::uint64_t>(limit))
    throw std::runtime_error("the scene's " + std::string(what) + " take " + std::to_string(bytes >> 20) +
                             " MiB; the device allows " + std::to_string((std::uint64_t(limit) * kTexelBytes) >> 20));
}

}  // namespace

DeviceGeometry::DeviceGeometry(std::vector<std::shared_ptr<const Primitive>> primitives, gl::BufferUse triangles)
    : primitives_(std::move(primitives)) {
  std::uint64_t vertices = 0, indices = 0;
  for (const auto& primitive : primitives_) {
    first_vertex_.push_back(static_cast<std::uint32_t>(vertices));
    first_index_.push_back(static_cast<std::uint32_t>(indices));
    vertices += primitive->positions.size();
    indices += primitive->indices.size();
  }
  check_texels(vertices * sizeof(DeviceVertex), "vertices");
  check_texels(indices / 3 * sizeof(DeviceTriangle), "triangles");
  rigid_vertices_ = static_cast<std::uint32_t>(vertices);
  rigid_triangles_ = static_cast<std::uint32_t>(indices / 3);
  indices_ = gl::Buffer("indices", indices * sizeof(std::uint32_t));
  for (std::size_t i = 0; i < primitives_.size(); ++i)
    indices_.upload(std::span<const std::uint32_t>(primitives_[i]->indices), first_index_[i] * sizeof(std::uint32_t));
  positions_ = gl::Buffer("positions", vertices * sizeof(glm::vec3));
  vertices_ = gl::Buffer("vertices", vertices * sizeof(DeviceVertex));
  triangles_ = gl::Buffer("triangles", indices / 3 * sizeof(DeviceTriangle), triangles);
  upload_rigid();
}

void DeviceGeometry::upload_rigid() {
  for (std::size_t i = 0; i < primitives_.size(); ++i) {
    positions_.upload(std::span<const glm::vec3>(primitives_[i]->positions), first_vertex_[i] * sizeof(glm::vec3));
    const std::vector<DeviceVertex> packed = pack_vertices(*primitives_[i], nullptr);
    vertices_.upload(std::span<const DeviceVertex>(packed), first_vertex_[i] * sizeof(DeviceVertex));
    const std::vector<DeviceTriangle> triangles = pack_triangles(*primitives_[i], nullptr);
    triangles_.upload(std::span<const DeviceTriangle>(triangles), first_index_[i] / 3 * sizeof(DeviceTriangle));
  }
}

void DeviceGeometry::reserve_deformed(std::uint32_t vertices, std::uint32_t triangles) {
  const std::uint64_t all_vertices = std::uint64_t{rigid_vertices_} + vertices;
  const std::uint64_t all_triangles = std::uint64_t{rigid_triangles_} + triangles;
  check_texels(all_vertices * sizeof(DeviceVertex), "deformed vertices");
  check_texels(all_triangles * sizeof(DeviceTriangle), "deformed triangles");
  const bool moved[] = {positions_.reserve(all_vertices * sizeof(glm::vec3)),
                        vertices_.reserve(all_vertices * sizeof(DeviceVertex)),
                        triangles_.reserve(all_triangles * sizeof(DeviceTriangle))};
  if (moved[0] || moved[1] || moved[2]) upload_rigid();
}

void DeviceGeometry::upload_deformed(const Primitive& primitive, const DeformedVertices& deformed,
                                     std::uint32_t first_vertex, std::uint32_t first_triangle) {
  positions_.upload(std::span<const glm::vec3>(deformed.positions), first_vertex * sizeof(glm::vec3));
  const std::vector<DeviceVertex> packed = pack_vertices(primitive, &deformed);
  vertices_.upload(std::span<const DeviceVertex>(packed), first_vertex * sizeof(DeviceVertex));
  const std::vector<DeviceTriangle> triangles = pack_triangles(primitive, &deformed);
  triangles_.upload(std::span<const DeviceTriangle>(triangles), first_triangle * sizeof(DeviceTriangle));
}

}  // namespace lightwell
