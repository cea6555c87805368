#include "renderer/scene/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace lightwell {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// `v` at unit length, or zero if it has none to speak of.
glm::vec3 unit_or_zero(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > std::numeric_limits<float>::min() && std::isfinite(length) ? v / length : glm::vec3(0.0f);
}

glm::vec3 in_plane(const glm::vec3& v, const glm::vec3& normal) {
  return unit_or_zero(v - glm::dot(normal, v) * normal);
}

/// Which way the texture lies on a triangle.
enum class Handedness : std::int8_t { kUnknown = 0, kRight = 1, kLeft = -1 };

struct Triangle {
  std::array<std::uint32_t, 3> welded{};  // vertices, equal ones with one number
  glm::vec3 along_u{0.0f};                // unit; zero if the texture coordinates have no area
  Handedness handedness = Handedness::kUnknown;
  bool flat = false;  // two corners in one place: takes part in nothing
};

class TangentBuilder {
 public:
  TangentBuilder(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                 std::span<const glm::vec2> uvs, std::span<const std::uint32_t> indices)
      : positions_(positions), normals_(normals), uvs_(uvs), indices_(indices) {}

  TangentMesh build() {
    weld();
    measure_triangles();
    pair_edges();
    spread_handedness();
    join_corners();
    sum_tangents();
    adopt_for_flat_triangles();
    return split_vertices();
  }

 private:
  std::size_t corner_count() const { return indices_.size(); }

  /// By sorting, which no choice of vertices makes slow.
  void weld() {
    const auto before = [this](std::uint32_t a, std::uint32_t b) {
      const glm::vec3 &p = positions_[a], &q = positions_[b], &m = normals_[a], &n = normals_[b];
      const glm::vec2 &s = uvs_[a], &t = uvs_[b];
      return std::tie(p.x, p.y, p.z, m.x, m.y, m.z, s.x, s.y) < std::tie(q.x, q.y, q.z, n.x, n.y, n.z, t.x, t.y);
    };
    std::vector<std::uint32_t> order(positions_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), before);
    welded_.resize(positions_.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      welded_[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? welded_[order[i - 1]] : order[i];
  }

  void measure_triangles() {
    triangles_.resize(indices_.size() / 3);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      Triangle& triangle = triangles_[t];
      const std::span<const std::uint32_t> v = indices_.subspan(3 * t, 3);
      for (std::size_t i = 0; i < 3; ++i) triangle.welded[i] = welded_[v[i]];
      const glm::vec3 p = positions_[v[0]], q = positions_[v[1]], r = positions_[v[2]];
      triangle.flat = p == q || q == r || r == p;
      const glm::vec2 to_q = uvs_[v[1]] - uvs_[v[0]], to_r = uvs_[v[2]] - uvs_[v[0]];
      const float area = to_q.x * to_r.y - to_q.y * to_r.x;
      if (triangle.flat || !(std::abs(area) > std::numeric_limits<float>::min())) continue;
      // glTF's v grows downwards in the image while the bitangent points up in it, hence the turned sign.
      triangle.handedness = area < 0.0f ? Handedness::kRight : Handedness::kLeft;
      const glm::vec3 direction = to_r.y * (q - p) - to_q.y * (r - p);
      triangle.along_u = unit_or_zero(area < 0.0f ? -direction : direction);
    }
  }

  /// For every edge of every triangle the one that runs along it the other way, if there is one.
  void pair_edges() {
    struct Edge {
      std::uint32_t low, high, corner;
      bool rising;
    };
    std::vector<Edge> edges;
    edges.reserve(corner_count());
    for (std::uint32_t corner = 0; corner < corner_count(); ++corner) {
      const Triangle& triangle = triangles_[corner / 3];
      if (triangle.flat) continue;
      const std::uint32_t a = triangle.welded[corner % 3], b = triangle.welded[(corner + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), corner, a < b});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
      return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
    });
    opposite_.assign(corner_count(), kNone);
    std::vector<std::uint32_t> waiting;  // corners of one edge, all running the same way, not yet paired
    bool waiting_rising = false;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Edge& edge = edges[i];
      if (i == 0 || edges[i - 1].low != edge.low || edges[i - 1].high != edge.high) waiting.clear();
      if (waiting.empty() || waiting_rising == edge.rising) {
        waiting.push_back(edge.corner);
        waiting_rising = edge.rising;
      } else {
        opposite_[edge.corner] = waiting.back();
        opposite_[waiting.back()] = edge.corner;
        waiting.pop_back();
      }
    }
  }

  /// Triangles whose texture coordinates have no area go with whatever neighbour reaches them first.
  void spread_handedness() {
    std::vector<std::uint32_t> queue;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (triangles_[t].handedness != Handedness::kUnknown) queue.push_back(t);
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (std::uint32_t corner = 3 * queue[i]; corner < 3 * queue[i] + 3; ++corner) {
        if (opposite_[corner] == kNone) continue;
        Triangle& neighbour = triangles_[opposite_[corner] / 3];
        if (neighbour.handedness != Handedness::kUnknown) continue;
        neighbour.handedness = triangles_[queue[i]].handedness;
        queue.push_back(opposite_[corner] / 3);
      }
    }
  }

  std::uint32_t find_group(std::uint32_t corner) {
    while (group_[corner] != corner) corner = group_[corner] = group_[group_[corner]];
    return corner;
  }

  /// Corners of one vertex belong together if one gets from one to the other over edges without changing hands.
  void join_corners() {
    group_.resize(corner_count());
    std::iota(group_.begin(), group_.end(), 0u);
    const auto next = [](std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
    for (std::uint32_t corner = 0; corner < corner_count(); ++corner) {
      const std::uint32_t other = opposite_[corner];
      if (other == kNone || triangles_[corner / 3].handedness != triangles_[other / 3].handedness) continue;
      // The edges run against each other: where one begins the other ends.
      group_[find_group(corner)] = find_group(next(other));
      group_[find_group(next(corner))] = find_group(other);
    }
    for (std::uint32_t corner = 0; corner < corner_count(); ++corner) group_[corner] = find_group(corner);
  }

  /// The angle of a corner, seen along the vertex normal.
  float angle_at(std::uint32_t corner, const glm::vec3& normal) const {
    const std::uint32_t first = corner / 3 * 3;
    const glm::vec3 here = positions_[indices_[corner]];
    const glm::vec3 to_next = positions_[indices_[first + (corner + 1) % 3]] - here;
    const glm::vec3 to_previous = positions_[indices_[first + (corner + 2) % 3]] - here;
    const float cosine = glm::dot(in_plane(to_next, normal), in_plane(to_previous, normal));
    return std::acos(std::clamp(cosine, -1.0f, 1.0f));
  }

  void sum_tangents() {
    std::vector<glm::vec3> sums(corner_count(), glm::vec3(0.0f));  // by group
    for (std::uint32_t corner = 0; corner < corner_count(); ++corner) {
      const Triangle& triangle = triangles_[corner / 3];
      if (triangle.along_u == glm::vec3(0.0f)) continue;
      const glm::vec3 normal = normals_[indices_[corner]];
      sums[group_[corner]] += angle_at(corner, normal) * in_plane(triangle.along_u, normal);
    }
    tangents_.resize(corner_count());
    for (std::uint32_t corner = 0; corner < corner_count(); ++corner) {
      const glm::vec3 direction = unit_or_zero(sums[group_[corner]]);
      const Handedness handedness = triangles_[corner / 3].handedness;
      if (direction == glm::vec3(0.0f) || handedness == Handedness::kUnknown)
        tangents_[corner] = any_tangent(normals_[indices_[corner]]);
      else
        tangents_[corner] = glm::vec4(direction, handedness == Handedness::kRight ? 1.0f : -1.0f);
    }
  }

  /// A triangle without extent takes, corner by corner, the tangent of a proper triangle at the same vertex.
  void adopt_for_flat_triangles() {
    std::vector<std::uint32_t> proper_corner(positions_.size(), kNone);  // by welded vertex
    for (std::uint32_t corner = 0; corner < corner_count(); ++corner) {
      const Triangle& triangle = triangles_[corner / 3];
      std::uint32_t& known = proper_corner[triangle.welded[corner % 3]];
      if (!triangle.flat && known == kNone) known = corner;
    }
    for (std::uint32_t corner = 0; corner < corner_count(); ++corner) {
      const Triangle& triangle = triangles_[corner / 3];
      const std::uint32_t proper = proper_corner[triangle.welded[corner % 3]];
      if (triangle.flat && proper != kNone) tangents_[corner] = tangents_[proper];
    }
  }

  TangentMesh split_vertices() const {
    TangentMesh mesh;
    mesh.source_vertices.resize(positions_.size());
    std::iota(mesh.source_vertices.begin(), mesh.source_vertices.end(), 0u);
    mesh.tangents.resize(positions_.size());
    for (std::size_t v = 0; v < positions_.size(); ++v) mesh.tangents[v] = any_tangent(normals_[v]);
    mesh.indices.reserve(corner_count());
    std::vector<bool> taken(positions_.size(), false);
    std::map<std::tuple<std::uint32_t, float, float, float, float>, std::uint32_t> copies;  // by vertex and tangent
    for (std::uint32_t corner = 0; corner < corner_count(); ++corner) {
      const std::uint32_t v = indices_[corner];
      const glm::vec4& tangent = tangents_[corner];
      if (!taken[v]) {
        taken[v] = true;
        mesh.tangents[v] = tangent;
      }
      if (mesh.tangents[v] == tangent) {
        mesh.indices.push_back(v);
        continue;
      }
      const auto fresh = static_cast<std::uint32_t>(mesh.tangents.size());
      const auto [copy, is_new] = copies.try_emplace({v, tangent.x, tangent.y, tangent.z, tangent.w}, fresh);
      if (is_new) {
        mesh.tangents.push_back(tangent);
        mesh.source_vertices.push_back(v);
      }
      mesh.indices.push_back(copy->second);
    }
    return mesh;
  }

  std::span<const glm::vec3> positions_, normals_;
  std::span<const glm::vec2> uvs_;
  std::span<const std::uint32_t> indices_;
  std::vector<std::uint32_t> welded_;  // per vertex: the first that equals it
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> opposite_;  // per corner, for the edge to the next corner: the corner it faces, or kNone
  std::vector<std::uint32_t> group_;     // per corner: the corner that stands for its group
  std::vector<glm::vec4> tangents_;      // per corner
};

}  // namespace

TangentMesh make_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                          std::span<const glm::vec2> uvs, std::span<const std::uint32_t> indices) {
  return TangentBuilder(positions, normals, uvs, indices).build();
}

glm::vec4 any_tangent(const glm::vec3& normal) {
  // Duff et al., "Building an Orthonormal Basis, Revisited", Journal of Computer Graphics Techniques 6(1), 2017.
  const float sign = std::copysign(1.0f, normal.z);
  const float a = -1.0f / (sign + normal.z);
  return {1.0f + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a, -sign * normal.x, 1.0f};
}

}  // namespace lightwell
