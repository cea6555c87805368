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

/// A surface sampled on a grid of points. Its front is where columns to the right and rows upward are seen so.
struct Grid {
  int columns = 0, rows = 0;
  bool closed = false;            // the last column is followed by the first
  std::vector<glm::vec3> points;  // row by row

  const glm::vec3& at(int column, int row) const { return points[static_cast<std::size_t>(row * columns + column)]; }
};

/// Samples `point(u, v)` with u and v in 0..1; when closed, u = 1 is u = 0 and is not sampled again.
Grid make_grid(int columns, int rows, bool closed, const std::function<glm::vec3(float u, float v)>& point);

/// Unit normals of a grid's points, smooth across a closed seam and over rows that shrink to one point.
std::vector<glm::vec3> grid_normals(const Grid& grid);

/// Triangles of one material in the making.
class MeshBuilder {
 public:
  std::size_t triangle_count() const { return indices_.size() / 3; }

  /// A flat triangle or quad; a, b, c (, d) counter-clockwise seen from the front.
  void triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
  void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

  /// A flat convex polygon, counter-clockwise seen from its front: n - 2 triangles.
  void polygon(std::span<const glm::vec3> corners);

  /// An axis-aligned box: 12 triangles, flat sides, facing outward.
  void box(const glm::vec3& low, const glm::vec3& high);

  /// A smooth surface; triangles without area (where a row shrinks to a point) are left out.
  /// With `wanted`, only the quads for which it is true are added, with the normals of the whole surface.
  void grid(const Grid& grid, const std::function<bool(int column, int row)>& wanted = {});

  /// Adds the triangles of `other`, placed by the affine `matrix`. A mirroring matrix keeps outsides outside.
  void append(const MeshBuilder& other, const glm::mat4& matrix = glm::mat4(1.0f));

  /// Adds raw vertices and triangles (indices into `vertices`).
  void add(std::span<const Vertex> vertices, std::span<const std::uint32_t> indices);

  /// The finished primitive: unit normals, tangents by make_tangents, bounds.
  Primitive finish(int material) const;

 private:
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace lightwell::builtin
