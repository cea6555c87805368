// A draped figure among two helicopters, one of which keeps its search light on her: 3284 triangles, all in motion.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "renderer/scene/builtin/airfield.h"
#include "renderer/scene/builtin/figure.h"
#include "renderer/scene/builtin/scenes.h"
#include "renderer/scene/builtin/shapes.h"

namespace lightwell::builtin {
namespace {

constexpr float kFigureScale = 6.0f;
constexpr float kPedestal = 2.4f;  // metres high

float turn(float phase) {
  return glm::two_pi<float>() * phase;
}

void add_place(SceneBuilder& scene) {
  const int sand = scene.material("sand", {0.37f, 0.235f, 0.14f}, 0.95f);
  const int stone = scene.material("travertine", {0.62f, 0.57f, 0.49f}, 0.8f);
  const int marble = scene.material("marble", {0.81f, 0.78f, 0.73f}, 0.4f);
  const int crimson = scene.material("crimson wash", {0.66f, 0.05f, 0.06f}, 0.9f);
  const int ultramarine = scene.material("ultramarine wash", {0.06f, 0.13f, 0.56f}, 0.9f);

  MeshBuilder plinth = bevelled_box({-2.0f, 0.5f, -1.9f}, {2.0f, kPedestal, 1.9f}, 0.12f);
  plinth.box({-2.9f, -0.4f, -2.8f}, {2.9f, 0.51f, 2.8f});
  MeshBuilder left, right;
  left.box({-12.8f, -1.0f, -10.0f}, {-12.0f, 12.0f, 5.0f});
  right.box({-7.0f, -1.0f, -13.8f}, {11.0f, 9.5f, -13.0f});
  scene.mesh_node("ground", {{dunes(8, 12, 12.0f), sand}});
  scene.mesh_node("pedestal", {{plinth, stone}});
  scene.mesh_node("crimson wall", {{left, crimson}});
  scene.mesh_node("ultramarine wall", {{right, ultramarine}});
  scene.mesh_node("figure", {{figure_body(), marble}, {figure_drapery(), marble}},
                  {{0.0f, kPedestal, 0.0f}, glm::quat(1, 0, 0, 0), glm::vec3(kFigureScale)});
}

}  // namespace

Scene make_venus() {
  Airfield field("venus", 12.0f);
  add_place(field.scene());
  const Flight near{{0.5f, 6.2f, 0.3f}, 7.4f, 7.0f, 0.30f, 0.6f, 1};
  const Flight high{{0.5f, 11.6f, -0.5f}, 8.6f, 7.4f, 0.62f, 0.5f, -1};
  const int searching = field.fly("yellow", {0.86f, 0.55f, 0.04f}, near);
  field.fly("white", {0.84f, 0.84f, 0.82f}, high);

  field.shine(22.0f, [](float phase) {
    return glm::vec3(-0.85f + 0.35f * std::sin(turn(phase)), -0.75f, -0.42f + 0.2f * std::cos(turn(phase)));
  });
  field.search_light(searching, 1200.0f, [near](float phase) {
    const glm::vec3 chest(0.0f, kPedestal + 1.2f * kFigureScale, 0.0f);
    return glm::inverse(near.attitude(phase)) * look_along(chest - near.position(phase));
  });
  field.camera(
      glm::radians(42.0f),
      [](float phase) {
        const float a = 0.15f + 0.45f * std::sin(turn(phase));
        return glm::vec3(21.0f * std::sin(a), 6.6f + 2.0f * std::cos(turn(phase)), 21.0f * std::cos(a));
      },
      [](float phase) { return glm::vec3(0.2f, 7.4f + 0.4f * std::sin(turn(phase)), 0.0f); });
  return std::move(field).finish();
}

}  // namespace lightwell::builtin
