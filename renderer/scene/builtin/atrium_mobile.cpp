#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/builtin/atrium.h"
#include "renderer/scene/builtin/shapes.h"

namespace lightwell::builtin::atrium {
namespace {

/// A thin leaf in the x-y plane with its stem end at the origin, pointing along +X.
MeshBuilder leaf(float length, float width) {
  std::vector<glm::vec2> outline;
  constexpr int kCorners = 24;
  for (int i = 0; i < kCorners; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / kCorners;
    const float along = 0.5f - 0.5f * std::cos(angle);
    outline.emplace_back(length * along, -0.5f * width * std::sin(angle) * (0.75f + 0.5f * along));
  }
  MeshBuilder mesh;
  mesh.append(extrude(outline, 0.012f), glm::translate(glm::mat4(1.0f), {0, 0, -0.006f}));
  return mesh;
}

/// A bowed wire from (-left, 0) to (right, 0) hung at the origin, with a thread of `drop` metres up to its hook.
MeshBuilder arm(float left, float right, float bow, float thread) {
  std::vector<glm::vec3> path;
  constexpr int kSpans = 10;
  for (int i = 0; i <= kSpans; ++i) {
    const float t = static_cast<float>(i) / kSpans, x = glm::mix(-left, right, t);
    const float reach = x < 0 ? x / left : x / right;
    path.emplace_back(x, -bow * reach * reach, 0.0f);
  }
  MeshBuilder mesh = tube(path, std::array{0.012f}, 6);
  mesh.append(tube(std::array{glm::vec3(0.0f), glm::vec3(0, thread, 0)}, std::array{0.004f}, 4));
  return mesh;
}

}  // namespace

void add_mobile(SceneBuilder& scene) {
  const int iron = scene.material("mobile wire", {0.05f, 0.05f, 0.05f}, 0.5f);
  const std::array colors = {scene.material("vermilion plate", {0.72f, 0.07f, 0.02f}, 0.5f),
                             scene.material("yellow plate", {0.85f, 0.55f, 0.03f}, 0.5f),
                             scene.material("black plate", {0.03f, 0.03f, 0.035f}, 0.4f),
                             scene.material("white plate", {0.82f, 0.81f, 0.78f}, 0.5f),
                             scene.material("cobalt plate", {0.03f, 0.13f, 0.55f}, 0.5f)};
  struct Level {
    float left, right, bow, thread, plate_length, plate_width;
    int color, turns;
  };
  const std::array levels = {
      Level{0.9f, 1.5f, 0.12f, 6.0f, 1.15f, 0.80f, 0, 1},   Level{0.75f, 1.1f, 0.10f, 0.35f, 0.80f, 0.55f, 2, -2},
      Level{0.6f, 0.85f, 0.08f, 0.32f, 0.62f, 0.44f, 1, 3}, Level{0.45f, 0.62f, 0.06f, 0.28f, 0.5f, 0.36f, 4, -3},
      Level{0.34f, 0.34f, 0.04f, 0.25f, 0.42f, 0.3f, 3, 4},
  };
  Animation& turning = scene.animation("mobile", 60.0f);
  glm::vec3 hook(0.2f, 5.3f, -2.6f);
  int parent = -1;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Level& l = levels[i];
    const float hang = i == 0 ? 0.0f : -l.thread;
    const int node = scene.mesh_node("mobile arm " + std::to_string(i + 1),
                                     {{arm(l.left, l.right, l.bow, i == 0 ? l.thread + 5.0f : l.thread), iron}},
                                     {hook + glm::vec3(0, hang, 0), glm::quat(1, 0, 0, 0), glm::vec3(1)}, parent);
    animate_spin(turning, node, {0, 1, 0}, l.turns,
                 glm::angleAxis(0.9f * static_cast<float>(i) + 0.4f, glm::vec3(0, 1, 0)));
    const glm::quat tilt =
        glm::angleAxis(glm::pi<float>(), glm::vec3(0, 1, 0)) * glm::angleAxis(-1.1f, glm::vec3(1, 0, 0));
    scene.mesh_node("mobile plate " + std::to_string(i + 1),
                    {{leaf(l.plate_length, l.plate_width), colors[static_cast<std::size_t>(l.color)]}},
                    {{-l.left, -l.bow, 0}, tilt, glm::vec3(1)}, node);
    if (i + 1 == levels.size())
      scene.mesh_node("mobile plate last", {{leaf(0.36f, 0.26f), colors[0]}},
                      {{l.right, -l.bow, 0}, glm::angleAxis(1.0f, glm::vec3(1, 0, 0)), glm::vec3(1)}, node);
    hook = {l.right, -l.bow, 0};
    parent = node;
  }
}

}  // namespace lightwell::builtin::atrium
