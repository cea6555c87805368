#include "renderer/scene/builtin/atrium.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "renderer/scene/builtin/scenes.h"

namespace lightwell::builtin {
namespace {

constexpr float kDayS = 60.0f;

/// The way the sun shines at `phase` of its going there and back: it crosses the well from left to right.
glm::vec3 sun_direction(float phase) {
  const float swing = std::cos(glm::two_pi<float>() * (phase + 0.57f));
  return {0.40f * swing, -1.0f, -0.06f - 0.16f * swing * swing};
}

}  // namespace

Scene make_atrium() {
  SceneBuilder scene("atrium");
  atrium::add_building(scene);
  atrium::add_furnishings(scene);
  atrium::add_mobile(scene);

  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::kDirectional;
  sun.color = {1.0f, 0.93f, 0.82f};
  sun.intensity = 24.0f;
  const int sun_node =
      scene.light_node(sun, {{0.0f, kDayS / 3, 0.0f}, look_along(sun_direction(0.0f)), glm::vec3(1.0f)});
  animate_rotation(scene.animation("sun", kDayS), sun_node, 16,
                   [](float phase) { return look_along(sun_direction(phase)); });

  scene.environment().zenith_radiance = {2.4f, 3.4f, 4.8f};
  scene.environment().horizon_radiance = {3.6f, 4.0f, 4.4f};
  scene.environment().ground_radiance = {0.0f, 0.0f, 0.0f};

  scene.camera_node("hall", {2.25f, 1.65f, 6.85f}, {-1.0f, 2.42f, -2.4f}, glm::radians(60.0f));
  scene.camera_node("aisle", {-4.4f, 1.6f, 6.8f}, {-1.0f, 2.0f, -1.0f}, glm::radians(55.0f));
  scene.camera_node("looking up", {-0.6f, 0.9f, -0.6f}, {0.2f, 6.5f, -2.9f}, glm::radians(75.0f));
  return std::move(scene).finish();
}

}  // namespace lightwell::builtin
