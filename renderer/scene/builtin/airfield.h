// What the scenes with helicopters share: the ground, the flights, the light's and the camera's motion.
#pragma once

#include <functional>
#include <string>

#include "renderer/scene/builtin/helicopter.h"
#include "renderer/scene/builtin/scene_builder.h"

namespace lightwell::builtin {

/// A round flight about `center`: the nose leads, the outer side rises.
struct Flight {
  glm::vec3 center;
  float radius_x, radius_z;
  float first;    // where it begins, 0..1 of the round
  float bob;      // metres up and down, twice a round
  int direction;  // 1: counter-clockwise seen from above, -1: clockwise

  glm::vec3 position(float phase) const;
  glm::quat attitude(float phase) const;
};

/// Dunes out to 34 m, `columns` x `rows` points, level within `level_m` of the middle: 2 * (columns - 1) * (rows - 1)
/// triangles.
MeshBuilder dunes(int columns, int rows, float level_m);

/// Builds one of these scenes: owns its animations until it is finished.
class Airfield {
 public:
  /// All flights, lights and the camera repeat after `duration_s`, a multiple of 1.5 s (two turns of a rotor).
  Airfield(std::string name, float duration_s);

  SceneBuilder& scene() { return scene_; }

  /// A helicopter of linear colour `hull` that flies `flight`; gives its node.
  int fly(const std::string& name, const glm::vec3& hull, const Flight& flight);

  /// A sun and sky; `direction(phase)` is the way the sun shines.
  void shine(float sun_lux, const std::function<glm::vec3(float phase)>& direction);

  /// A warm search light of `intensity_cd` ahead of a helicopter's nose, clear of its skids, turned by
  /// `attitude(phase)` relative to it.
  void search_light(int helicopter, float intensity_cd, const std::function<glm::quat(float phase)>& attitude);

  /// The camera: at `eye(phase)`, looking at `target(phase)`.
  void camera(float yfov, const std::function<glm::vec3(float phase)>& eye,
              const std::function<glm::vec3(float phase)>& target);

  Scene finish() &&;

 private:
  SceneBuilder scene_;
  Animation motion_, main_turning_, tail_turning_;
  HelicopterPaint paint_{};
};

}  // namespace lightwell::builtin
