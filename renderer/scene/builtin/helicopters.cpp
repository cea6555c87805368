// Three helicopters over a landing place between two coloured walls: 1522 triangles, everything in motion.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/builtin/helicopter.h"
#include "renderer/scene/builtin/scenes.h"
#include "renderer/scene/builtin/shapes.h"

namespace lightwell::builtin {
namespace {

constexpr float kDurationS = 12.0f;

float turn(float phase) {
  return glm::two_pi<float>() * phase;
}

/// A round flight about `center`: the nose leads, the outer side rises.
struct Flight {
  glm::vec3 center;
  float radius_x, radius_z, first, bob;
  int direction;  // 1 counter-clockwise seen from above

  float angle(float phase) const { return turn(static_cast<float>(direction) * phase + first); }
  glm::vec3 position(float phase) const {
    const float a = angle(phase);
    return center + glm::vec3(radius_x * std::cos(a), bob * std::sin(2.0f * a), -radius_z * std::sin(a));
  }
  glm::quat attitude(float phase) const {
    const float a = angle(phase);
    const auto side = static_cast<float>(direction);
    const glm::vec3 heading = side * glm::vec3(-radius_x * std::sin(a), 0.0f, -radius_z * std::cos(a));
    const glm::quat yaw = glm::angleAxis(std::atan2(heading.x, heading.z), glm::vec3(0, 1, 0));
    const glm::quat bank = glm::angleAxis(-0.22f * side, glm::vec3(0, 0, 1));
    return yaw * bank * glm::angleAxis(0.08f, glm::vec3(1, 0, 0));
  }
};

/// Low dunes that leave the landing place level and rise to hide where the ground ends.
MeshBuilder ground() {
  MeshBuilder mesh;
  mesh.grid(make_grid(12, 13, false, [](float u, float v) {
    const auto spread = [](float t) {
      return 60.0f * std::copysign(std::pow(std::abs(2.0f * t - 1.0f), 1.5f), 2.0f * t - 1.0f);
    };
    const float x = spread(u), z = -spread(v), away = std::hypot(x, z);
    const float dune = 1.3f + std::sin(0.21f * x + 0.13f * z + 0.6f) + 0.7f * std::sin(0.11f * x - 0.27f * z + 2.0f);
    return glm::vec3(x, glm::smoothstep(9.0f, 26.0f, away) * dune + 9.5f * glm::smoothstep(24.0f, 62.0f, away), z);
  }));
  return mesh;
}

}  // namespace

Scene make_helicopters() {
  SceneBuilder scene("helicopters");
  const int sand = scene.material("sand", {0.47f, 0.345f, 0.225f}, 0.95f);
  const int concrete = scene.material("concrete", {0.56f, 0.55f, 0.53f}, 0.85f);
  const int mark = scene.material("marking", {0.85f, 0.83f, 0.78f}, 0.8f);
  const int vermilion = scene.material("vermilion wall", {0.72f, 0.16f, 0.05f}, 0.9f);
  const int teal = scene.material("teal wall", {0.05f, 0.42f, 0.44f}, 0.9f);
  const int glass = scene.material("glass", {0.03f, 0.05f, 0.07f}, 0.12f);
  const int metal = scene.material("metal", {0.30f, 0.30f, 0.31f}, 0.4f, 0.8f);
  const int blades = scene.material("rotor blades", {0.10f, 0.10f, 0.11f}, 0.6f);
  const std::array hulls = {scene.material("yellow hull", {0.86f, 0.55f, 0.04f}, 0.35f),
                            scene.material("white hull", {0.84f, 0.84f, 0.82f}, 0.35f),
                            scene.material("blue hull", {0.05f, 0.17f, 0.58f}, 0.35f)};

  scene.mesh_node("ground", {{ground(), sand}});
  scene.mesh_node("landing place", {{cylinder(5.2f, 5.0f, -0.3f, 0.2f, 23), concrete}});
  MeshBuilder letter;
  for (const glm::vec4& r :
       {glm::vec4(-1.7f, -2.2f, -0.9f, 2.2f), glm::vec4(0.9f, -2.2f, 1.7f, 2.2f), glm::vec4(-0.9f, -0.4f, 0.9f, 0.4f)})
    letter.quad({r.x, 0.21f, r.w}, {r.z, 0.21f, r.w}, {r.z, 0.21f, r.y}, {r.x, 0.21f, r.y});
  scene.mesh_node("letter H", {{letter, mark}});
  MeshBuilder left, right;
  left.box({-13.0f, -1.0f, -9.0f}, {-12.2f, 7.5f, 7.0f});
  right.box({-9.0f, -1.0f, -13.0f}, {9.0f, 6.0f, -12.2f});
  scene.mesh_node("vermilion wall", {{left, vermilion}});
  scene.mesh_node("teal wall", {{right, teal}});

  const std::array flights = {Flight{{0.5f, 3.6f, 0.5f}, 8.6f, 8.0f, 0.05f, 0.5f, 1},
                              Flight{{-1.0f, 7.2f, -1.5f}, 6.2f, 6.6f, 0.40f, 0.4f, -1},
                              Flight{{0.0f, 2.6f, 0.0f}, 0.7f, 0.7f, 0.0f, 0.35f, 1}};
  Animation main_turning{"main rotors", {}, {}, 0.75f}, tail_turning{"tail rotors", {}, {}, 0.5f};
  Animation motion{"flight", {}, {}, kDurationS};
  std::array<int, 3> helicopters{};
  const std::array names = {"yellow helicopter", "white helicopter", "blue helicopter"};
  for (std::size_t i = 0; i < flights.size(); ++i) {
    const Flight& flight = flights[i];
    helicopters[i] = add_helicopter(scene, names[i], {hulls[i], glass, metal, blades},
                                    {flight.position(0), flight.attitude(0), glm::vec3(1)}, main_turning, tail_turning);
    animate_translation(motion, helicopters[i], 16, [&](float phase) { return flight.position(phase); });
    animate_rotation(motion, helicopters[i], 16, [&](float phase) { return flight.attitude(phase); });
  }

  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::kDirectional;
  sun.color = {1.0f, 0.90f, 0.76f};
  sun.intensity = 22.0f;
  const auto sun_direction = [](float phase) {
    return glm::vec3(-0.95f + 0.5f * std::sin(turn(phase)), -0.8f, -0.45f + 0.25f * std::cos(turn(phase)));
  };
  const int sun_node = scene.light_node(sun, {{0, 30, 0}, look_along(sun_direction(0)), glm::vec3(1)});
  animate_rotation(motion, sun_node, 12, [&](float phase) { return look_along(sun_direction(phase)); });

  Light lamp;
  lamp.name = "search light";
  lamp.kind = LightKind::kSpot;
  lamp.color = {1.0f, 0.62f, 0.28f};
  lamp.intensity = 2500.0f;
  lamp.inner_cone_angle = 0.22f;
  lamp.outer_cone_angle = 0.42f;
  const int lamp_node =
      scene.light_node(lamp, {{0, -0.9f, 1.0f}, look_along({0, -1, 0.35f}), glm::vec3(1)}, helicopters[1]);
  animate_rotation(motion, lamp_node, 12, [](float phase) {
    return look_along({0.45f * std::sin(turn(phase)), -1.0f, 0.35f + 0.3f * std::cos(turn(phase))});
  });

  scene.environment().zenith_radiance = {1.2f, 2.1f, 3.9f};
  scene.environment().horizon_radiance = {3.4f, 3.9f, 4.4f};
  scene.environment().ground_radiance = {1.5f, 1.15f, 0.8f};

  const auto eye = [](float phase) {
    const float a = 0.62f + 0.34f * std::sin(turn(phase));
    return glm::vec3(24.0f * std::sin(a), 8.2f + 2.2f * std::cos(turn(phase)), 24.0f * std::cos(a));
  };
  const auto gaze = [=](float phase) {
    return glm::vec3(-0.6f, 3.4f + 0.5f * std::sin(turn(phase)), -0.8f) - eye(phase);
  };
  const int camera = scene.camera_node("flying camera", eye(0), eye(0) + gaze(0), glm::radians(44.0f));
  animate_translation(motion, camera, 12, eye);
  animate_rotation(motion, camera, 12, [&](float phase) { return look_along(gaze(phase)); });

  Scene result = std::move(scene).finish();
  result.animations = {std::move(motion), std::move(main_turning), std::move(tail_turning)};
  return result;
}

}  // namespace lightwell::builtin
