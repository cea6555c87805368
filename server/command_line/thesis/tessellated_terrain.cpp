#include "server/command_line/thesis/tessellated_terrain.h"

#include <array>
#include <cmath>

#include "renderer/check.h"
#include "renderer/scene/builtin/scene_builder.h"

namespace lightwell {

namespace {

using builtin::MeshBuilder;
using builtin::SceneBuilder;
using builtin::Vertex;

constexpr int kQuadsPerSide = 27;  // 2 * 27^2 triangles
static_assert(2 * kQuadsPerSide * kQuadsPerSide == kTerrainTriangles);
constexpr float kHalfSide_m = 14.0f;

float height_m(float x, float z) {
  // The walls stand at the left and at the back; hills lie between them.
  const float wall = 9.0f * glm::smoothstep(-11.5f, -13.0f, std::min(x, z));
  return wall + 0.9f * std::sin(0.7f * x + 0.4f) * std::cos(0.8f * z) + 0.5f * std::sin(1.3f * z + 0.3f * x);
}

Vertex corner(int column, int row) {
  const auto place = [](int i) { return kHalfSide_m * (2.0f * static_cast<float>(i) / kQuadsPerSide - 1.0f); };
  const auto point = [&](int c, int r) { return glm::vec3(place(c), height_m(place(c), -place(r)), -place(r)); };
  const glm::vec3 along_x = point(column + 1, row) - point(column - 1, row);
  const glm::vec3 along_z = point(column, row + 1) - point(column, row - 1);
  const glm::vec2 uv(static_cast<float>(column), static_cast<float>(row));
  return {point(column, row), glm::normalize(glm::cross(along_x, along_z)), uv};
}

// What lies between three corners, as a rasteriser would find it.
Vertex between(const std::array<Vertex, 3>& corners, float u, float v) {
  const auto mix = [&](auto member) {
    return (1.0f - u - v) * (corners[0].*member) + u * (corners[1].*member) + v * (corners[2].*member);
  };
  return {mix(&Vertex::position), glm::normalize(mix(&Vertex::normal)), mix(&Vertex::uv)};
}

void add_divided(MeshBuilder& mesh, const std::array<Vertex, 3>& corners, int divisions) {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  const float step = 1.0f / static_cast<float>(divisions);
  for (int row = 0; row <= divisions; ++row) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const auto above = first + static_cast<std::uint32_t>(divisions - row + 1);
    for (int column = 0; column <= divisions - row; ++column) {
      vertices.push_back(between(corners, static_cast<float>(column) * step, static_cast<float>(row) * step));
      const auto i = static_cast<std::uint32_t>(column);
      if (column < divisions - row) indices.insert(indices.end(), {first + i, first + i + 1, above + i});
      if (column < divisions - row - 1) indices.insert(indices.end(), {first + i + 1, above + i + 1, above + i});
    }
  }
  mesh.add(vertices, indices);
}

// The walls and the ground between them, each of its own colour.
std::array<MeshBuilder, 3> divided_terrain(int divisions) {
  std::array<MeshBuilder, 3> parts;
  for (int row = 0; row < kQuadsPerSide; ++row)
    for (int column = 0; column < kQuadsPerSide; ++column) {
      MeshBuilder& part = parts[column < 3 ? 0 : row >= kQuadsPerSide - 3 ? 1 : 2];
      const Vertex a = corner(column, row), b = corner(column + 1, row);
      const Vertex c = corner(column + 1, row + 1), d = corner(column, row + 1);
      add_divided(part, {a, b, c}, divisions);
      add_divided(part, {a, c, d}, divisions);
    }
  return parts;
}

void add_lights(SceneBuilder& scene) {
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::kDirectional;
  sun.color = {1.0f, 0.9f, 0.76f};
  sun.intensity = 22.0f;
  scene.light_node(sun, {{0.0f, 30.0f, 0.0f}, builtin::look_along({-0.9f, -0.8f, -0.5f}), glm::vec3(1.0f)});
  Light lamp;
  lamp.name = "search light";
  lamp.kind = LightKind::kSpot;
  lamp.intensity = 1500.0f;
  lamp.inner_cone_angle = 0.22f;
  lamp.outer_cone_angle = 0.42f;
  scene.light_node(lamp, {{6.0f, 9.0f, 6.0f}, builtin::look_along({-0.6f, -1.0f, -0.5f}), glm::vec3(1.0f)});
  scene.environment().zenith_radiance = {1.2f, 2.1f, 3.9f};
  scene.environment().horizon_radiance = {3.4f, 3.9f, 4.4f};
  scene.environment().ground_radiance = {2.5f, 1.55f, 0.95f};
}

}  // namespace

Scene make_tessellated_terrain(int divisions) {
  LIGHTWELL_CHECK_OP(divisions, >=, 1);
  LIGHTWELL_CHECK_OP(divisions, <=, kMaxTerrainDivisions);
  SceneBuilder scene("tessellated terrain");
  const std::array<MeshBuilder, 3> parts = divided_terrain(divisions);
  const int vermilion = scene.material("vermilion", {0.72f, 0.16f, 0.05f});
  const int teal = scene.material("teal", {0.05f, 0.42f, 0.44f});
  const int sand = scene.material("sand", {0.5f, 0.42f, 0.32f});
  scene.mesh_node("terrain", {{parts[0], vermilion}, {parts[1], teal}, {parts[2], sand}});
  add_lights(scene);
  scene.camera_node("camera", {13.0f, 10.0f, 17.0f}, {-2.5f, 1.5f, -3.0f}, glm::radians(44.0f));
  return std::move(scene).finish();
}

}  // namespace lightwell
