// Three helicopters over a landing place between two coloured walls: 1522 triangles, everything in motion.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "renderer/scene/builtin/airfield.h"
#include "renderer/scene/builtin/scenes.h"
#include "renderer/scene/builtin/shapes.h"

namespace lightwell::builtin {
namespace {

float turn(float phase) {
  return glm::two_pi<float>() * phase;
}

/// 3 x 380 triangles fly; these are the other 382.
void add_place(SceneBuilder& scene) {
  const int sand = scene.material("sand", {0.37f, 0.235f, 0.14f}, 0.95f);
  const int concrete = scene.material("concrete", {0.56f, 0.55f, 0.53f}, 0.85f);
  const int marking = scene.material("marking", {0.85f, 0.83f, 0.78f}, 0.8f);
  const int vermilion = scene.material("vermilion wash", {0.72f, 0.16f, 0.05f}, 0.9f);
  const int teal = scene.material("teal wash", {0.05f, 0.42f, 0.44f}, 0.9f);

  MeshBuilder letter, left, right;
  for (const glm::vec4& bar :
       {glm::vec4(-1.7f, -2.2f, -0.9f, 2.2f), glm::vec4(0.9f, -2.2f, 1.7f, 2.2f), glm::vec4(-0.9f, -0.4f, 0.9f, 0.4f)})
    letter.quad({bar.x, 0.21f, bar.w}, {bar.z, 0.21f, bar.w}, {bar.z, 0.21f, bar.y}, {bar.x, 0.21f, bar.y});
  left.box({-14.8f, -1.0f, -10.0f}, {-14.0f, 8.0f, 7.0f});
  right.box({-10.0f, -1.0f, -14.8f}, {10.0f, 6.5f, -14.0f});
  scene.mesh_node("ground", {{dunes(12, 13, 10.0f), sand}});
  scene.mesh_node("landing place", {{cylinder(5.2f, 5.0f, -0.3f, 0.2f, 23), concrete}});
  scene.mesh_node("letter H", {{letter, marking}});
  scene.mesh_node("vermilion wall", {{left, vermilion}});
  scene.mesh_node("teal wall", {{right, teal}});
}

}  // namespace

Scene make_helicopters() {
  Airfield field("helicopters", 12.0f);
  add_place(field.scene());
  field.fly("yellow", {0.86f, 0.55f, 0.04f}, {{0.5f, 4.4f, 0.5f}, 8.6f, 8.0f, 0.05f, 0.5f, 1});
  const int white = field.fly("white", {0.84f, 0.84f, 0.82f}, {{-1.0f, 8.0f, -1.5f}, 6.2f, 6.6f, 0.40f, 0.4f, -1});
  field.fly("blue", {0.05f, 0.17f, 0.58f}, {{0.0f, 2.6f, 0.0f}, 0.7f, 0.7f, 0.0f, 0.35f, 1});

  field.shine(22.0f, [](float phase) {
    return glm::vec3(-0.95f + 0.5f * std::sin(turn(phase)), -0.8f, -0.45f + 0.25f * std::cos(turn(phase)));
  });
  field.search_light(white, 1500.0f, [](float phase) {
    return look_along({0.45f * std::sin(turn(phase)), -1.0f, 0.35f + 0.3f * std::cos(turn(phase))});
  });
  field.camera(
      glm::radians(44.0f),
      [](float phase) {
        const float a = 0.62f + 0.34f * std::sin(turn(phase));
        return glm::vec3(24.0f * std::sin(a), 8.2f + 2.2f * std::cos(turn(phase)), 24.0f * std::cos(a));
      },
      [](float phase) { return glm::vec3(-0.6f, 3.8f + 0.5f * std::sin(turn(phase)), -0.8f); });
  return std::move(field).finish();
}

}  // namespace lightwell::builtin
