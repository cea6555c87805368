#include "renderer/scene/builtin/helicopter.h"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/builtin/shapes.h"

namespace lightwell::builtin {
namespace {

/// A cross-section of a hull: place along z, height of its middle, half width and half height.
struct Station {
  float z, y, half_width, half_height;
};

/// A hull through `stations` from tail to nose, each a slightly squared ellipse.
Grid hull(std::span<const Station> stations, int columns) {
  Grid grid{columns, static_cast<int>(stations.size()), true, {}};
  for (const Station& s : stations)
    for (int c = 0; c < columns; ++c) {
      const float angle = glm::two_pi<float>() * (static_cast<float>(c) + 0.5f) / static_cast<float>(columns);
      const auto squared = [](float v) { return std::copysign(std::pow(std::abs(v), 0.84f), v); };
      grid.points.emplace_back(s.half_width * squared(std::cos(angle)), s.y + s.half_height * squared(std::sin(angle)),
                               s.z);
    }
  return grid;
}

constexpr int kHullColumns = 8;
constexpr std::array kFuselage = {
    Station{-5.40f, 0.44f, 0.00f, 0.00f}, Station{-5.32f, 0.44f, 0.09f, 0.11f}, Station{-3.20f, 0.38f, 0.16f, 0.18f},
    Station{-1.55f, 0.28f, 0.32f, 0.38f}, Station{-0.85f, 0.06f, 0.70f, 0.78f}, Station{0.15f, -0.02f, 0.82f, 0.94f},
    Station{1.15f, -0.14f, 0.74f, 0.78f}, Station{1.85f, -0.34f, 0.44f, 0.42f}, Station{2.12f, -0.44f, 0.00f, 0.00f},
};
constexpr int kFirstGlassRow = 5;

/// The windscreen and the roof windows: the upper columns ahead of the doors, down to the chin below the nose.
bool is_glass(int column, int row) {
  return row >= kFirstGlassRow && row <= 6 && column <= 3;
}

MeshBuilder hull_part(bool glass) {
  MeshBuilder mesh;
  mesh.grid(hull(kFuselage, kHullColumns),
            [=](int column, int row) { return is_glass((column + kHullColumns) % kHullColumns, row) == glass; });
  return mesh;
}

MeshBuilder tail_and_engine() {
  constexpr std::array kEngine = {Station{-1.75f, 0.62f, 0.00f, 0.00f}, Station{-1.60f, 0.66f, 0.20f, 0.18f},
                                  Station{-0.50f, 0.92f, 0.40f, 0.30f}, Station{0.42f, 0.90f, 0.00f, 0.00f}};
  MeshBuilder mesh;
  mesh.grid(hull(kEngine, 6));
  // The fin stands in the (y, z) plane, the stabiliser lies in (x, z).
  constexpr std::array kFin = {glm::vec2(-4.75f, 0.45f), glm::vec2(-5.45f, 1.42f), glm::vec2(-5.78f, 1.42f),
                               glm::vec2(-5.40f, 0.40f)};
  const glm::mat4 upright({0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {0.03f, 0, 0, 1});
  mesh.append(extrude(kFin, 0.06f), upright);
  mesh.box({-0.95f, 0.36f, -4.55f}, {0.95f, 0.41f, -4.05f});
  return mesh;
}

MeshBuilder mast_and_skids() {
  MeshBuilder mesh =
      tube(std::array{glm::vec3(0.0f, 0.95f, -0.25f), glm::vec3(0.0f, 1.62f, -0.25f)}, std::array{0.075f}, 5);
  for (const float side : {-1.0f, 1.0f}) {
    const std::array skid = {glm::vec3(side * 1.02f, -1.36f, -1.75f), glm::vec3(side * 1.02f, -1.36f, 1.15f),
                             glm::vec3(side * 1.02f, -1.26f, 1.62f), glm::vec3(side * 1.02f, -1.02f, 1.86f)};
    mesh.append(tube(skid, std::array{0.06f}, 4));
  }
  for (const float z : {-0.95f, 0.85f}) {
    const std::array bow = {glm::vec3(-1.02f, -1.34f, z), glm::vec3(-0.5f, -0.72f, z), glm::vec3(0.5f, -0.72f, z),
                            glm::vec3(1.02f, -1.34f, z)};
    mesh.append(tube(bow, std::array{0.05f}, 4));
  }
  return mesh;
}

/// Blades about +Y, from `root` to `tip` metres out.
MeshBuilder rotor(int blades, float root, float tip, float chord, float thickness, int hub_sides, float hub_radius) {
  MeshBuilder blade, mesh = cylinder(hub_radius, 0.6f * hub_radius, -hub_radius, hub_radius, hub_sides);
  blade.box({root, -0.5f * thickness, -0.35f * chord}, {tip, 0.5f * thickness, 0.65f * chord});
  for (int i = 0; i < blades; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(blades);
    const glm::mat4 pitch = glm::rotate(glm::mat4(1.0f), 0.10f, {1, 0, 0});
    mesh.append(blade, glm::rotate(glm::mat4(1.0f), angle, {0, 1, 0}) * pitch);
  }
  return mesh;
}

}  // namespace

int add_helicopter(SceneBuilder& scene, std::string name, const HelicopterPaint& paint, const Transform& local,
                   Animation& main_turning, Animation& tail_turning) {
  MeshBuilder body = hull_part(false);
  body.append(tail_and_engine());
  const int node = scene.mesh_node(
      name, {{body, paint.hull}, {hull_part(true), paint.glass}, {mast_and_skids(), paint.metal}}, local);

  const int main_rotor =
      scene.mesh_node(name + " main rotor", {{rotor(3, 0.12f, 4.4f, 0.30f, 0.05f, 6, 0.16f), paint.blades}},
                      {{0.0f, 1.62f, -0.25f}, glm::quat(1, 0, 0, 0), glm::vec3(1.0f)}, node);
  animate_spin(main_turning, main_rotor, {0, 1, 0}, 1, glm::quat(1, 0, 0, 0));

  // The tail rotor's axis is the helicopter's -X.
  const glm::quat sideways = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 0, 1));
  const int tail_rotor =
      scene.mesh_node(name + " tail rotor", {{rotor(2, 0.04f, 0.78f, 0.12f, 0.03f, 4, 0.06f), paint.blades}},
                      {{-0.17f, 0.62f, -5.22f}, sideways, glm::vec3(1.0f)}, node);
  animate_spin(tail_turning, tail_rotor, {0, 1, 0}, 1, sideways);
  return node;
}

}  // namespace lightwell::builtin
