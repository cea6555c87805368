#include "renderer/scene/builtin/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "renderer/check.h"

namespace lightwell::builtin {
namespace {

float cross_2d(const glm::vec2& a, const glm::vec2& b) {
  return a.x * b.y - a.y * b.x;
}

bool inside_triangle(const glm::vec2& p, const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  return cross_2d(b - a, p - a) >= 0.0f && cross_2d(c - b, p - b) >= 0.0f && cross_2d(a - c, p - c) >= 0.0f;
}

/// Cuts a simple polygon into triangles by clipping its ears; prefers the roundest ear, for few slivers.
std::vector<std::array<std::size_t, 3>> triangulate(std::span<const glm::vec2> polygon) {
  std::vector<std::size_t> left(polygon.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<std::array<std::size_t, 3>> triangles;
  while (left.size() >= 3) {
    std::size_t best = left.size();
    float best_quality = 0.0f;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const std::size_t before = left[(i + left.size() - 1) % left.size()], after = left[(i + 1) % left.size()];
      const glm::vec2 &a = polygon[before], &b = polygon[left[i]], &c = polygon[after];
      const float area = cross_2d(b - a, c - b);
      const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
      const float quality = area / (longest * longest);
      if (quality <= std::max(best_quality, 1e-6f)) continue;
      const bool clear = std::none_of(left.begin(), left.end(), [&](std::size_t other) {
        return other != before && other != left[i] && other != after && inside_triangle(polygon[other], a, b, c);
      });
      if (!clear) continue;
      best = i;
      best_quality = quality;
    }
    LIGHTWELL_CHECK_OP(best, <, left.size());  // else the polygon crosses itself or runs clockwise
    triangles.push_back({left[(best + left.size() - 1) % left.size()], left[best], left[(best + 1) % left.size()]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return triangles;
}

}  // namespace

MeshBuilder bevelled_box(const glm::vec3& low, const glm::vec3& high, float bevel) {
  const glm::vec3 center = 0.5f * (low + high), half = 0.5f * (high - low);
  // The corner in the octant `sign`, on the side that faces along `axis`.
  const auto corner = [&](const glm::ivec3& sign, int axis) {
    glm::vec3 p = half - bevel;
    p[axis] = half[axis];
    return center + p * glm::vec3(sign);
  };
  MeshBuilder mesh;
  const auto add = [&](std::initializer_list<glm::vec3> corners) {
    std::vector<glm::vec3> points(corners);
    const glm::vec3 n = glm::cross(points[1] - points[0], points[2] - points[0]);
    if (glm::dot(n, points[0] + points[1] + points[2] - 3.0f * center) < 0.0f)
      std::reverse(points.begin(), points.end());
    mesh.polygon(points);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int other = (axis + 1) % 3, third = (axis + 2) % 3;
    for (const int side : {-1, 1}) {
      const auto on_side = [&](int s, int t) {
        glm::ivec3 sign(0);
        sign[axis] = side, sign[other] = s, sign[third] = t;
        return corner(sign, axis);
      };
      add({on_side(-1, -1), on_side(1, -1), on_side(1, 1), on_side(-1, 1)});
      for (const int across : {-1, 1}) {  // the edge between this side and the next axis' side
        glm::ivec3 near(0), far(0);
        near[axis] = far[axis] = side, near[other] = far[other] = across, near[third] = -1, far[third] = 1;
        add({corner(near, axis), corner(near, other), corner(far, other), corner(far, axis)});
      }
    }
  }
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    add({corner(sign, 0), corner(sign, 1), corner(sign, 2)});
  }
  return mesh;
}

MeshBuilder lathe(std::span<const glm::vec2> profile, int segments) {
  MeshBuilder mesh;
  for (std::size_t begin = 0; begin + 1 < profile.size();) {
    std::size_t end = begin + 1;  // the smooth piece begin..end
    while (end + 1 < profile.size() && profile[end + 1] != profile[end]) ++end;
    Grid grid{segments, static_cast<int>(end - begin) + 1, true, {}};
    for (std::size_t i = begin; i <= end; ++i)
      for (int s = 0; s < segments; ++s) {
        const float angle = glm::two_pi<float>() * static_cast<float>(s) / static_cast<float>(segments);
        grid.points.emplace_back(profile[i].x * std::cos(angle), profile[i].y, -profile[i].x * std::sin(angle));
      }
    mesh.grid(grid);
    begin = end + 1;
  }
  return mesh;
}

MeshBuilder sphere(float radius, int segments, int rows) {
  std::vector<glm::vec2> profile;
  for (int r = 0; r <= rows; ++r) {
    const float angle = glm::pi<float>() * static_cast<float>(r) / static_cast<float>(rows);
    const bool pole = r == 0 || r == rows;
    profile.emplace_back(pole ? 0.0f : radius * std::sin(angle), -radius * std::cos(angle));
  }
  return lathe(profile, segments);
}

MeshBuilder cylinder(float bottom_radius, float top_radius, float bottom, float top, int sides) {
  MeshBuilder mesh = lathe(std::array{glm::vec2(bottom_radius, bottom), glm::vec2(top_radius, top)}, sides);
  mesh.append(disk(top_radius, top, sides));
  MeshBuilder end = disk(bottom_radius, -bottom, sides);
  // Turned half about the x axis: y becomes -y and the corners keep their places among the cylinder's.
  mesh.append(end, glm::mat4({1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {0, 0, 0, 1}));
  return mesh;
}

MeshBuilder disk(float radius, float y, int corners) {
  std::vector<glm::vec3> points;
  for (int i = 0; i < corners; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(corners);
    points.emplace_back(radius * std::cos(angle), y, -radius * std::sin(angle));
  }
  MeshBuilder mesh;
  mesh.polygon(points);
  return mesh;
}

MeshBuilder tube(std::span<const glm::vec3> path, std::span<const float> radii, int sides) {
  const auto direction = [&](std::size_t i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, path.size() - 1);
    return glm::normalize(path[after] - path[before]);
  };
  // A frame carried along the path without twist.
  glm::vec3 forward = direction(0);
  const glm::vec3 helper = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  glm::vec3 side = glm::normalize(glm::cross(helper, forward));
  Grid grid{sides, static_cast<int>(path.size()), true, {}};
  for (std::size_t i = 0; i < path.size(); ++i) {
    const glm::vec3 next = direction(i);
    side = glm::normalize(side - next * glm::dot(next, side));
    forward = next;
    const glm::vec3 up = glm::cross(forward, side);
    const float radius = radii.size() == 1 ? radii[0] : radii[i];
    for (int s = 0; s < sides; ++s) {
      const float angle = glm::two_pi<float>() * (static_cast<float>(s) + 0.5f) / static_cast<float>(sides);
      grid.points.push_back(path[i] + radius * (std::cos(angle) * side + std::sin(angle) * up));
    }
  }
  MeshBuilder mesh;
  mesh.grid(grid);
  std::vector<glm::vec3> begin(grid.points.begin(), grid.points.begin() + sides);
  const std::vector<glm::vec3> end(grid.points.end() - sides, grid.points.end());
  std::reverse(begin.begin(), begin.end());
  mesh.polygon(begin);
  mesh.polygon(end);
  return mesh;
}

MeshBuilder extrude(std::span<const glm::vec2> polygon, float depth) {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  const auto count = static_cast<std::uint32_t>(polygon.size());
  for (const float z : {depth, 0.0f})
    for (const glm::vec2& p : polygon)
      vertices.push_back({glm::vec3(p, z), {0.0f, 0.0f, z > 0.0f ? 1.0f : -1.0f}, {z > 0.0f ? p.x : -p.x, -p.y}});
  for (const auto& [a, b, c] : triangulate(polygon)) {
    const auto ia = static_cast<std::uint32_t>(a), ib = static_cast<std::uint32_t>(b),
               ic = static_cast<std::uint32_t>(c);
    indices.insert(indices.end(), {ia, ib, ic, count + ia, count + ic, count + ib});
  }

  const auto outward = [&](std::size_t edge) {
    const glm::vec2 along = glm::normalize(polygon[(edge + 1) % count] - polygon[edge]);
    return glm::vec2(along.y, -along.x);
  };
  const auto normal_at = [&](std::size_t edge, std::size_t neighbour) {
    const glm::vec2 own = outward(edge), other = outward(neighbour);
    return glm::vec3(glm::dot(own, other) > 0.866f ? glm::normalize(own + other) : own, 0.0f);
  };
  float around = 0.0f;
  for (std::size_t edge = 0; edge < count; ++edge) {
    const std::size_t next = (edge + 1) % count;
    const glm::vec3 n0 = normal_at(edge, (edge + count - 1) % count), n1 = normal_at(edge, next);
    const float length = glm::distance(polygon[edge], polygon[next]);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back({glm::vec3(polygon[edge], 0.0f), n0, {0.0f, around}});
    vertices.push_back({glm::vec3(polygon[next], 0.0f), n1, {0.0f, around + length}});
    vertices.push_back({glm::vec3(polygon[next], depth), n1, {depth, around + length}});
    vertices.push_back({glm::vec3(polygon[edge], depth), n0, {depth, around}});
    indices.insert(indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    around += length;
  }
  MeshBuilder mesh;
  mesh.add(vertices, indices);
  return mesh;
}

MeshBuilder sheet(const Grid& middle, float thickness) {
  const std::vector<glm::vec3> normals = grid_normals(middle);
  Grid front = middle, back = middle;
  for (int r = 0; r < middle.rows; ++r)
    for (int c = 0; c < middle.columns; ++c) {
      const auto i = static_cast<std::size_t>(r * middle.columns + c);
      const auto mirrored = static_cast<std::size_t>(r * middle.columns + middle.columns - 1 - c);
      front.points[i] = middle.points[i] + 0.5f * thickness * normals[i];
      back.points[mirrored] = middle.points[i] - 0.5f * thickness * normals[i];
    }
  MeshBuilder mesh;
  mesh.grid(front);
  mesh.grid(back);
  const int last = middle.columns - 1, top = middle.rows - 1;
  for (int c = 0; c < last; ++c) {
    mesh.quad(back.at(last - c, 0), back.at(last - c - 1, 0), front.at(c + 1, 0), front.at(c, 0));
    mesh.quad(front.at(c, top), front.at(c + 1, top), back.at(last - c - 1, top), back.at(last - c, top));
  }
  for (int r = 0; r < top; ++r) {
    mesh.quad(front.at(0, r), front.at(0, r + 1), back.at(last, r + 1), back.at(last, r));
    mesh.quad(front.at(last, r), back.at(0, r), back.at(0, r + 1), front.at(last, r + 1));
  }
  return mesh;
}

}  // namespace lightwell::builtin
