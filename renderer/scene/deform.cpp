#include "renderer/scene/deform.h"

#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

/// `v` at unit length, or `fallback` where it has none (a collapsed scale, opposing displacements).
glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float squared = glm::dot(v, v);
  return squared > 0.0f && std::isfinite(squared) ? v * (1.0f / std::sqrt(squared)) : fallback;
}

void add_scaled(std::vector<glm::vec3>& values, const std::vector<glm::vec3>& displacements, float weight) {
  const std::size_t count = std::min(values.size(), displacements.size());
  for (std::size_t i = 0; i < count; ++i) values[i] += weight * displacements[i];
}

void add_scaled(std::vector<glm::vec4>& values, const std::vector<glm::vec3>& displacements, float weight) {
  const std::size_t count = std::min(values.size(), displacements.size());
  for (std::size_t i = 0; i < count; ++i) values[i] += glm::vec4(weight * displacements[i], 0.0f);
}

/// Weighted sum of a vertex's four joint matrices.
glm::mat4 blend(std::span<const glm::mat4> matrices, const glm::uvec4& joints, const glm::vec4& weights) {
  const auto last = static_cast<unsigned>(matrices.size() - 1);
  const glm::mat4& a = matrices[std::min(joints.x, last)];
  const glm::mat4& b = matrices[std::min(joints.y, last)];
  const glm::mat4& c = matrices[std::min(joints.z, last)];
  const glm::mat4& d = matrices[std::min(joints.w, last)];
  glm::mat4 sum;
  for (int column = 0; column < 4; ++column)
    sum[column] = weights.x * a[column] + weights.y * b[column] + weights.z * c[column] + weights.w * d[column];
  return sum;
}

}  // namespace

DeformedVertices morph(const Primitive& primitive, std::span<const float> weights) {
  DeformedVertices vertices{primitive.positions, primitive.normals, primitive.tangents};
  const std::size_t count = std::min(weights.size(), primitive.morph_targets.size());
  bool normals_moved = false, tangents_moved = false;
  for (std::size_t i = 0; i < count; ++i) {
    if (weights[i] == 0.0f) continue;
    const MorphTarget& target = primitive.morph_targets[i];
    add_scaled(vertices.positions, target.positions, weights[i]);
    add_scaled(vertices.normals, target.normals, weights[i]);
    add_scaled(vertices.tangents, target.tangents, weights[i]);
    normals_moved |= !target.normals.empty();
    tangents_moved |= !target.tangents.empty();
  }
  if (normals_moved)
    for (std::size_t i = 0; i < vertices.normals.size(); ++i)
      vertices.normals[i] = unit_or(vertices.normals[i], primitive.normals[i]);
  if (tangents_moved)
    for (std::size_t i = 0; i < vertices.tangents.size(); ++i)
      vertices.tangents[i] = glm::vec4(unit_or(glm::vec3(vertices.tangents[i]), glm::vec3(primitive.tangents[i])),
                                       primitive.tangents[i].w);
  return vertices;
}

void skin(const Primitive& primitive, std::span<const glm::mat4> world_from_mesh, DeformedVertices& vertices) {
  if (world_from_mesh.empty()) return;
  const std::size_t count = std::min({vertices.positions.size(), primitive.joints.size(), primitive.weights.size()});
  const bool with_normals = vertices.normals.size() >= count, with_tangents = vertices.tangents.size() >= count;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::mat4 matrix = blend(world_from_mesh, primitive.joints[i], primitive.weights[i]);
    const glm::vec3 x(matrix[0]), y(matrix[1]), z(matrix[2]);
    const glm::vec3 p = vertices.positions[i];
    vertices.positions[i] = p.x * x + p.y * y + p.z * z + glm::vec3(matrix[3]);

    // The cofactor matrix is the inverse transpose times the determinant: no division, safe for a collapsed scale.
    // Only the determinant's sign matters to a direction: a mirror turns the normal and the handedness over.
    const glm::vec3 cofactor_x = glm::cross(y, z);
    const float side = glm::dot(x, cofactor_x) < 0.0f ? -1.0f : 1.0f;
    if (with_normals) {
      const glm::vec3 n = vertices.normals[i];
      vertices.normals[i] = unit_or(side * (n.x * cofactor_x + n.y * glm::cross(z, x) + n.z * glm::cross(x, y)), n);
    }
    if (with_tangents) {
      const glm::vec4 t = vertices.tangents[i];
      vertices.tangents[i] = glm::vec4(unit_or(t.x * x + t.y * y + t.z * z, glm::vec3(t)), side * t.w);
    }
  }
}

}  // namespace lightwell
