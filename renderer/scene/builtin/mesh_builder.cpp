#include "renderer/scene/builtin/mesh_builder.h"

#include <algorithm>
#include <cmath>

namespace lightwell::builtin {
namespace {

glm::vec3 any_perpendicular(const glm::vec3& n) {
  const glm::vec3 axis = std::abs(n.x) < 0.7f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.0f);
  return glm::normalize(glm::cross(axis, n));
}

/// Sums of the triangles' directions of growing u and v at each vertex, made perpendicular to its normal.
std::vector<glm::vec4> tangents_of(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices) {
  std::vector<glm::vec3> along_u(vertices.size(), glm::vec3(0.0f)), along_v(along_u);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Vertex &a = vertices[indices[i]], &b = vertices[indices[i + 1]], &c = vertices[indices[i + 2]];
    const glm::vec3 ab = b.position - a.position, ac = c.position - a.position;
    const glm::vec2 uv_ab = b.uv - a.uv, uv_ac = c.uv - a.uv;
    const float area_uv = uv_ab.x * uv_ac.y - uv_ac.x * uv_ab.y;
    if (area_uv == 0.0f) continue;
    const float side = area_uv < 0.0f ? -1.0f : 1.0f;
    const glm::vec3 u = side * (ab * uv_ac.y - ac * uv_ab.y), v = side * (ac * uv_ab.x - ab * uv_ac.x);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      along_u[indices[i + corner]] += u;
      along_v[indices[i + corner]] += v;
    }
  }
  std::vector<glm::vec4> tangents;
  tangents.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const glm::vec3& n = vertices[i].normal;
    const glm::vec3 projected = along_u[i] - n * glm::dot(n, along_u[i]);
    const float length = glm::length(projected);
    const glm::vec3 t = length > 1e-12f ? projected / length : any_perpendicular(n);
    tangents.emplace_back(t, glm::dot(glm::cross(n, t), along_v[i]) < 0.0f ? -1.0f : 1.0f);
  }
  return tangents;
}

}  // namespace

void MeshBuilder::add(std::span<const Vertex> vertices, std::span<const std::uint32_t> indices) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
  for (const std::uint32_t i : indices) indices_.push_back(first + i);
}

void MeshBuilder::triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 n = glm::normalize(glm::cross(b - a, c - a));
  const glm::vec3 u = glm::normalize(b - a), v = glm::cross(n, u);
  const auto uv = [&](const glm::vec3& p) { return glm::vec2(glm::dot(p - a, u), -glm::dot(p - a, v)); };
  add(std::array{Vertex{a, n, uv(a)}, Vertex{b, n, uv(b)}, Vertex{c, n, uv(c)}}, std::array{0u, 1u, 2u});
}

void MeshBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  const glm::vec3 n = glm::normalize(glm::cross(c - a, d - b));
  const glm::vec3 u = glm::normalize(b - a), v = glm::cross(n, u);
  // uv in metres, v downward as glTF's image rows go.
  const auto uv = [&](const glm::vec3& p) { return glm::vec2(glm::dot(p - a, u), -glm::dot(p - a, v)); };
  add(std::array{Vertex{a, n, uv(a)}, Vertex{b, n, uv(b)}, Vertex{c, n, uv(c)}, Vertex{d, n, uv(d)}},
      std::array{0u, 1u, 2u, 0u, 2u, 3u});
}

void MeshBuilder::box(const glm::vec3& low, const glm::vec3& high) {
  const auto at = [&](int x, int y, int z) {
    return glm::vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));  // front, +z
  quad(at(1, 0, 0), at(0, 0, 0), at(0, 1, 0), at(1, 1, 0));  // back
  quad(at(1, 0, 1), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1));  // right, +x
  quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));  // left
  quad(at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), at(0, 1, 0));  // top, +y
  quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));  // bottom
}

void MeshBuilder::append(const MeshBuilder& other, const glm::mat4& matrix) {
  const glm::mat3 linear(matrix);
  const bool mirrors = glm::determinant(linear) < 0.0f;
  const glm::mat3 for_normals = glm::transpose(glm::inverse(linear));
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  for (const Vertex& v : other.vertices_)
    vertices_.push_back(
        {glm::vec3(matrix * glm::vec4(v.position, 1.0f)), glm::normalize(for_normals * v.normal), v.uv});
  for (std::size_t i = 0; i + 2 < other.indices_.size(); i += 3) {
    indices_.push_back(first + other.indices_[i]);
    indices_.push_back(first + other.indices_[mirrors ? i + 2 : i + 1]);
    indices_.push_back(first + other.indices_[mirrors ? i + 1 : i + 2]);
  }
}

Primitive MeshBuilder::finish(int material) const {
  Primitive primitive;
  primitive.material = material;
  primitive.indices = indices_;
  for (const Vertex& v : vertices_) {
    primitive.positions.push_back(v.position);
    primitive.normals.push_back(v.normal);
    primitive.uv0.push_back(v.uv);
  }
  primitive.tangents = tangents_of(vertices_, indices_);
  if (!vertices_.empty()) {
    primitive.bounds_min = primitive.bounds_max = vertices_.front().position;
    for (const Vertex& v : vertices_) {
      primitive.bounds_min = glm::min(primitive.bounds_min, v.position);
      primitive.bounds_max = glm::max(primitive.bounds_max, v.position);
    }
  }
  return primitive;
}

}  // namespace lightwell::builtin
