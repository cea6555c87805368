#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/builtin/atrium.h"
#include "renderer/scene/builtin/shapes.h"

namespace lightwell::builtin::atrium {
namespace {

struct Plate {
  float length, width;
  int material;
};

/// An arm, hung at its origin by a thread.
struct Level {
  float left, right;  // how far it reaches to its plate and to the next arm
  float bow;          // how far its ends sink
  float thread;       // up to what it hangs from
  Plate plate;
  int turns;  // per minute; negative: clockwise seen from above
};

/// A thin rounded leaf in the x-y plane, its stem end at the origin, pointing along +X.
MeshBuilder leaf(float length, float width) {
  constexpr int kCorners = 22;
  constexpr float kThickness = 0.014f;
  std::vector<glm::vec2> outline;
  for (int i = 0; i < kCorners; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / kCorners;
    const float along = 0.5f - 0.5f * std::cos(angle);
    outline.emplace_back(length * along, -0.5f * width * std::sin(angle) * (0.75f + 0.5f * along));
  }
  MeshBuilder mesh;
  mesh.append(extrude(outline, kThickness), glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, -0.5f * kThickness}));
  return mesh;
}

/// A bowed wire and its thread.
MeshBuilder arm(const Level& level) {
  constexpr int kSpans = 10;
  std::vector<glm::vec3> path;
  for (int i = 0; i <= kSpans; ++i) {
    const float x = glm::mix(-level.left, level.right, static_cast<float>(i) / kSpans);
    const float reach = x < 0.0f ? x / level.left : x / level.right;
    path.emplace_back(x, -level.bow * reach * reach, 0.0f);
  }
  MeshBuilder mesh = tube(path, std::array{0.011f}, 5);
  mesh.append(tube(std::array{glm::vec3(0.0f), glm::vec3(0.0f, level.thread, 0.0f)}, std::array{0.004f}, 4));
  return mesh;
}

/// Plates lie aslant, pointing away from the arm.
void add_plate(SceneBuilder& scene, std::string name, const Plate& plate, const glm::vec3& at, int parent) {
  const glm::quat outward = glm::angleAxis(at.x < 0.0f ? glm::pi<float>() : 0.0f, glm::vec3(0, 1, 0));
  const glm::quat tilt = glm::angleAxis(-0.95f, glm::vec3(1, 0, 0));
  scene.mesh_node(std::move(name), {{leaf(plate.length, plate.width), plate.material}},
                  {at, outward * tilt, glm::vec3(1.0f)}, parent);
}

}  // namespace

void add_mobile(SceneBuilder& scene) {
  const int wire = scene.material("mobile wire", {0.05f, 0.05f, 0.05f}, 0.5f);
  const int vermilion = scene.material("vermilion plate", {0.74f, 0.08f, 0.02f}, 0.5f);
  const int yellow = scene.material("yellow plate", {0.86f, 0.56f, 0.03f}, 0.5f);
  const int black = scene.material("black plate", {0.03f, 0.03f, 0.035f}, 0.4f);
  const int white = scene.material("white plate", {0.82f, 0.81f, 0.78f}, 0.5f);
  const int cobalt = scene.material("cobalt plate", {0.03f, 0.15f, 0.58f}, 0.5f);

  // From the top down: each arm carries a plate on its left and the next arm on its right; the last carries two plates.
  // The turns per minute have no common rhythm but the minute, so that the figure hardly ever repeats.
  // All reaches together stay clear of the cloths and the walls.
  const std::array<Level, 6> levels = {{{0.85f, 0.66f, 0.12f, 11.0f, {1.25f, 0.88f, vermilion}, 3},
                                        {0.62f, 0.46f, 0.09f, 0.50f, {0.86f, 0.60f, black}, -2},
                                        {0.50f, 0.34f, 0.07f, 0.44f, {0.70f, 0.48f, yellow}, 4},
                                        {0.40f, 0.25f, 0.06f, 0.38f, {0.58f, 0.40f, white}, -3},
                                        {0.32f, 0.18f, 0.05f, 0.32f, {0.46f, 0.32f, cobalt}, 5},
                                        {0.24f, 0.18f, 0.04f, 0.26f, {0.36f, 0.25f, vermilion}, -4}}};
  Animation& turning = scene.animation("mobile", 60.0f);
  glm::vec3 hook(-0.1f, 5.3f, -1.7f);
  int parent = -1;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Level& level = levels[i];
    const std::string number = std::to_string(i + 1);
    const glm::vec3 at = i == 0 ? hook : hook - glm::vec3(0.0f, level.thread, 0.0f);
    const glm::quat first = glm::angleAxis(1.9f * static_cast<float>(i) + 0.5f, glm::vec3(0, 1, 0));
    const int node =
        scene.mesh_node("mobile arm " + number, {{arm(level), wire}}, {at, first, glm::vec3(1.0f)}, parent);
    animate_spin(turning, node, {0, 1, 0}, level.turns, first);
    add_plate(scene, "mobile plate " + number, level.plate, {-level.left, -level.bow, 0.0f}, node);
    if (i + 1 == levels.size())
      add_plate(scene, "mobile plate " + std::to_string(i + 2), {0.30f, 0.21f, yellow}, {level.right, -level.bow, 0.0f},
                node);
    hook = {level.right, -level.bow, 0.0f};
    parent = node;
  }
}

}  // namespace lightwell::builtin::atrium
