// A small kit for making meshes in code. Everything is counter-clockwise seen from its outside (or from its front).
#pragma once

#include <functional>
#include <span>

#include "renderer/scene/scene.h"

namespace lightwell::builtin {

struct Vertex {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0.0f};
  glm::vec2 uv{0.0f};
};

/// Triangles of one material in the making. Shapes append; `transform` and `append` place them.
class MeshBuilder {
 public:
  std::size_t triangle_count() const { return indices_.size() / 3; }

  /// A flat triangle or quad; a, b, c (, d) counter-clockwise seen from the front.
  void triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
  void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

  /// An axis-aligned box: 12 triangles, flat sides, facing outward.
  void box(const glm::vec3& low, const glm::vec3& high);

  /// Adds the triangles of `other`, placed by the affine `matrix`. A mirroring matrix keeps outsides outside.
  void append(const MeshBuilder& other, const glm::mat4& matrix = glm::mat4(1.0f));

  /// Adds raw vertices and triangles (indices into `vertices`).
  void add(std::span<const Vertex> vertices, std::span<const std::uint32_t> indices);

  /// The finished primitive: unit normals, MikkTSpace-style tangents from uv0, bounds.
  Primitive finish(int material) const;

 private:
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace lightwell::builtin
