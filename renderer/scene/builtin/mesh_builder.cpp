#include "renderer/scene/builtin/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/scene/bounds.h"
#include "renderer/scene/tangents.h"

namespace lightwell::builtin {
namespace {

/// Twice the area below which a triangle counts as none, in square metres.
constexpr float kNoArea = 1e-8f;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

bool shrinks_to_a_point(const Grid& grid, int row) {
  for (int c = 1; c < grid.columns; ++c)
    if (glm::distance(grid.at(c, row), grid.at(0, row)) > 1e-5f) return false;
  return true;
}

}  // namespace

Grid make_grid(int columns, int rows, bool closed, const std::function<glm::vec3(float u, float v)>& point) {
  Grid grid{columns, rows, closed, {}};
  const auto last_column = static_cast<float>(closed ? columns : columns - 1);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      grid.points.push_back(
          point(static_cast<float>(c) / last_column, static_cast<float>(r) / static_cast<float>(rows - 1)));
  return grid;
}

std::vector<glm::vec3> grid_normals(const Grid& grid) {
  std::vector<glm::vec3> normals(grid.points.size(), glm::vec3(0.0f));
  const int spans = grid.closed ? grid.columns : grid.columns - 1;
  for (int r = 0; r + 1 < grid.rows; ++r)
    for (int c = 0; c < spans; ++c) {
      const int right = (c + 1) % grid.columns;
      // The cross product of a quad's diagonals is twice its area along its mean normal.
      const glm::vec3 n = glm::cross(grid.at(right, r + 1) - grid.at(c, r), grid.at(c, r + 1) - grid.at(right, r));
      for (const int corner :
           {r * grid.columns + c, r * grid.columns + right, (r + 1) * grid.columns + c, (r + 1) * grid.columns + right})
        normals[at(corner)] += n;
    }
  for (int r = 0; r < grid.rows; ++r) {
    if (!shrinks_to_a_point(grid, r)) continue;
    glm::vec3 sum(0.0f);
    for (int c = 0; c < grid.columns; ++c) sum += normals[at(r * grid.columns + c)];
    for (int c = 0; c < grid.columns; ++c) normals[at(r * grid.columns + c)] = sum;
  }
  for (glm::vec3& n : normals) n = glm::normalize(n);
  return normals;
}

void MeshBuilder::grid(const Grid& grid, const std::function<bool(int column, int row)>& wanted) {
  const std::vector<glm::vec3> normals = grid_normals(grid);
  const int columns = grid.closed ? grid.columns + 1 : grid.columns;  // the seam has two sides in uv
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> vertex_of(at(columns * grid.rows), kUnused);
  const auto vertex = [&](int c, int r) {
    std::uint32_t& index = vertex_of[at(r * columns + c)];
    if (index == kUnused) {
      const std::size_t source = at(r * grid.columns + c % grid.columns);
      index = static_cast<std::uint32_t>(vertices_.size());
      vertices_.push_back({grid.points[source],
                           normals[source],
                           {static_cast<float>(c) / static_cast<float>(columns - 1),
                            1.0f - static_cast<float>(r) / static_cast<float>(grid.rows - 1)}});
    }
    return index;
  };
  const auto add_unless_flat = [&](const glm::ivec2& a, const glm::ivec2& b, const glm::ivec2& c) {
    const auto position = [&](const glm::ivec2& i) { return grid.at(i.x % grid.columns, i.y); };
    if (glm::length(glm::cross(position(b) - position(a), position(c) - position(a))) < kNoArea) return;
    for (const glm::ivec2& i : {a, b, c}) indices_.push_back(vertex(i.x, i.y));
  };
  for (int r = 0; r + 1 < grid.rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      if (wanted && !wanted(c, r)) continue;
      add_unless_flat({c, r}, {c + 1, r}, {c + 1, r + 1});
      add_unless_flat({c, r}, {c + 1, r + 1}, {c, r + 1});
    }
}

void MeshBuilder::polygon(std::span<const glm::vec3> corners) {
  glm::vec3 n(0.0f);
  for (std::size_t i = 2; i < corners.size(); ++i)
    n += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  n = glm::normalize(n);
  const glm::vec3 u = glm::normalize(corners[1] - corners[0]), v = glm::cross(n, u);
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const glm::vec3& p : corners) {
    // uv in metres, v downward as glTF's image rows go.
    vertices.push_back({p, n, {glm::dot(p - corners[0], u), -glm::dot(p - corners[0], v)}});
    const auto i = static_cast<std::uint32_t>(vertices.size() - 1);
    if (i >= 2) indices.insert(indices.end(), {0u, i - 1, i});
  }
  add(vertices, indices);
}

void MeshBuilder::add(std::span<const Vertex> vertices, std::span<const std::uint32_t> indices) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
  for (const std::uint32_t i : indices) indices_.push_back(first + i);
}

void MeshBuilder::triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  polygon(std::array{a, b, c});
}

void MeshBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  polygon(std::array{a, b, c, d});
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
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  for (const Vertex& v : vertices_) {
    positions.push_back(v.position);
    normals.push_back(v.normal);
    uvs.push_back(v.uv);
  }
  TangentMesh split = make_tangents(positions, normals, uvs, indices_);

  Primitive primitive;
  primitive.material = material;
  primitive.indices = std::move(split.indices);
  primitive.tangents = std::move(split.tangents);
  for (const std::uint32_t source : split.source_vertices) {
    primitive.positions.push_back(positions[source]);
    primitive.normals.push_back(normals[source]);
    primitive.uv0.push_back(uvs[source]);
  }
  fill_bounds(primitive);
  return primitive;
}

}  // namespace lightwell::builtin
