// The triangles of a set of primitives on the device, rigid and deformed.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/scene/pose.h"

namespace lightwell {

/// Vertices and indices of a set of primitives, uploaded once and kept while the scene uses just these.
class DeviceGeometry {
 public:
  /// `triangles`: where those live.
  DeviceGeometry(std::vector<std::shared_ptr<const Primitive>> primitives, gl::BufferUse triangles);
  const std::vector<std::shared_ptr<const Primitive>>& primitives() const { return primitives_; }

  /// Makes room for this many after the rigid ones.
  void reserve_deformed(std::uint32_t vertices, std::uint32_t triangles);
  /// Writes an instance's deformed vertices and triangles; what does not deform is taken from the primitive.
  void upload_deformed(const Primitive& primitive, const DeformedVertices& deformed, std::uint32_t first_vertex,
                       std::uint32_t first_triangle);

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
};

}  // namespace lightwell
