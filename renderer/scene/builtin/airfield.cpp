#include "renderer/scene/builtin/airfield.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lightwell::builtin {
namespace {

/// Small, for the sake of shadow maps that cover the whole scene; beyond it the environment looks like more sand.
constexpr float kGroundHalf = 34.0f;

}  // namespace

glm::vec3 Flight::position(float phase) const {
  const float a = glm::two_pi<float>() * (static_cast<float>(direction) * phase + first);
  return center + glm::vec3(radius_x * std::cos(a), bob * std::sin(2.0f * a), -radius_z * std::sin(a));
}

glm::quat Flight::attitude(float phase) const {
  const float a = glm::two_pi<float>() * (static_cast<float>(direction) * phase + first);
  const auto side = static_cast<float>(direction);
  const glm::vec2 heading = -side * glm::vec2(radius_x * std::sin(a), radius_z * std::cos(a));
  const glm::quat yaw = glm::angleAxis(std::atan2(heading.x, heading.y), glm::vec3(0.0f, 1.0f, 0.0f));
  const glm::quat bank = glm::angleAxis(-0.22f * side, glm::vec3(0.0f, 0.0f, 1.0f));
  return yaw * bank * glm::angleAxis(0.08f, glm::vec3(1.0f, 0.0f, 0.0f));
}

MeshBuilder dunes(int columns, int rows, float level_m) {
  // Points lie closer in the middle.
  const auto spread = [](float t) {
    const float from_middle = 2.0f * t - 1.0f;
    return kGroundHalf * std::copysign(std::pow(std::abs(from_middle), 1.3f), from_middle);
  };
  MeshBuilder mesh;
  mesh.grid(make_grid(columns, rows, false, [&](float u, float v) {
    const float x = spread(u), z = -spread(v), away = std::hypot(x, z);
    const float dune = 1.3f + std::sin(0.21f * x + 0.13f * z + 0.6f) + 0.7f * std::sin(0.11f * x - 0.27f * z + 2.0f);
    const float rim = 3.0f * glm::smoothstep(level_m + 8.0f, kGroundHalf, away);
    return glm::vec3(x, glm::smoothstep(level_m, level_m + 14.0f, away) * dune + rim, z);
  }));
  return mesh;
}

Airfield::Airfield(std::string name, float duration_s)
    : scene_(std::move(name)),
      motion_{"flight", {}, {}, duration_s},
      main_turning_{"main rotors", {}, {}, 0.75f},
      tail_turning_{"tail rotors", {}, {}, 0.5f} {
  paint_.glass = scene_.material("glass", {0.03f, 0.05f, 0.07f}, 0.12f);
  paint_.metal = scene_.material("metal", {0.30f, 0.30f, 0.31f}, 0.4f, 0.8f);
  paint_.blades = scene_.material("rotor blades", {0.10f, 0.10f, 0.11f}, 0.6f);
}

int Airfield::fly(const std::string& name, const glm::vec3& hull, const Flight& flight) {
  paint_.hull = scene_.material(name + " hull", hull, 0.35f);
  const Transform first{flight.position(0.0f), flight.attitude(0.0f), glm::vec3(1.0f)};
  const int node = add_helicopter(scene_, name + " helicopter", paint_, first, main_turning_, tail_turning_);
  animate_translation(motion_, node, 16, [&](float phase) { return flight.position(phase); });
  animate_rotation(motion_, node, 16, [&](float phase) { return flight.attitude(phase); });
  return node;
}

void Airfield::shine(float sun_lux, const std::function<glm::vec3(float phase)>& direction) {
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::kDirectional;
  sun.color = {1.0f, 0.90f, 0.76f};
  sun.intensity = sun_lux;
  const int node = scene_.light_node(sun, {{0.0f, 30.0f, 0.0f}, look_along(direction(0.0f)), glm::vec3(1.0f)});
  animate_rotation(motion_, node, 12, [&](float phase) { return look_along(direction(phase)); });

  Environment& sky = scene_.environment();
  sky.zenith_radiance = {1.2f, 2.1f, 3.9f};
  sky.horizon_radiance = {3.4f, 3.9f, 4.4f};
  sky.ground_radiance = {2.5f, 1.55f, 0.95f};  // the desert beyond the dunes
}

void Airfield::search_light(int helicopter, float intensity_cd, const std::function<glm::quat(float phase)>& attitude) {
  Light lamp;
  lamp.name = "search light";
  lamp.kind = LightKind::kSpot;
  lamp.color = {1.0f, 0.62f, 0.28f};
  lamp.intensity = intensity_cd;
  lamp.inner_cone_angle = 0.22f;
  lamp.outer_cone_angle = 0.42f;
  const Transform ahead_of_the_nose{{0.0f, -0.75f, 2.6f}, attitude(0.0f), glm::vec3(1.0f)};
  const int node = scene_.light_node(lamp, ahead_of_the_nose, helicopter);
  animate_rotation(motion_, node, 16, attitude);
}

void Airfield::camera(float yfov, const std::function<glm::vec3(float phase)>& eye,
                      const std::function<glm::vec3(float phase)>& target) {
  const int node = scene_.camera_node("flying camera", eye(0.0f), target(0.0f), yfov);
  animate_translation(motion_, node, 12, eye);
  animate_rotation(motion_, node, 12, [&](float phase) { return look_along(target(phase) - eye(phase)); });
}

Scene Airfield::finish() && {
  Scene scene = std::move(scene_).finish();
  scene.animations = {std::move(motion_), std::move(main_turning_), std::move(tail_turning_)};
  return scene;
}

}  // namespace lightwell::builtin
