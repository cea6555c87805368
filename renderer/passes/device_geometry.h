// The triangles of a set of primitives on the device, rigid and deformed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/passes/deformation_sources.h"
#include "renderer/scene/pose.h"

namespace lightwell {

/// An instance's vertices to be made, and where they go in a DeviceGeometry.
struct DeformTask {
  std::shared_ptr<const DeformedShape> shape;
  std::size_t primitive;  // its number in the geometry
  std::uint32_t first_vertex, first_triangle;
};

/// Vertices and indices of a set of primitives, uploaded once and kept while the scene uses just these.
class DeviceGeometry {
 public:
  /// `use`: where positions and triangles live, which code on the processor may want to read.
  DeviceGeometry(std::vector<std::shared_ptr<const Primitive>> primitives, gl::BufferUse use);
  const std::vector<std::shared_ptr<const Primitive>>& primitives() const { return primitives_; }
  /// Which of them it is; it must be one of them, and they must be sorted.
  std::size_t number_of(const std::shared_ptr<const Primitive>& primitive) const;

  /// Makes room for this many after the rigid ones.
  void reserve_deformed(std::uint32_t vertices, std::uint32_t triangles);
  /// What those are made from, once there is room for them.
  const DeformationSources& deformation_sources() const { return *deformation_sources_; }
  /// Whether the deformed ones are already what the tasks ask for; then they are taken to become so.
  bool becomes(const std::vector<DeformTask>& tasks);

  std::uint32_t first_vertex(std::size_t primitive) const { return first_vertex_[primitive]; }
  std::uint32_t first_index(std::size_t primitive) const { return first_index_[primitive]; }
  std::uint32_t rigid_vertices() const { return rigid_vertices_; }
  std::uint32_t rigid_triangles() const { return rigid_triangles_; }
  const gl::Buffer& positions() const { return positions_; }
  const gl::Buffer& vertices() const { return vertices_; }
  const gl::Buffer& indices() const { return indices_; }
  const gl::Buffer& triangles() const { return triangles_; }

 private:
  void upload_rigid();
  std::vector<std::shared_ptr<const Primitive>> primitives_;
  std::vector<std::uint32_t> first_vertex_, first_index_;
  std::uint32_t rigid_vertices_ = 0, rigid_triangles_ = 0;
  gl::Buffer positions_, vertices_, indices_, triangles_;
  std::optional<DeformationSources> deformation_sources_;
  std::vector<DeformTask> deformed_;
};

}  // namespace lightwell
