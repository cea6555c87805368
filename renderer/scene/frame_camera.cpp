#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/scene/pose.h"

namespace lightwell {

PlacedCamera frame_camera(const Pose& pose, float aspect_ratio) {
  PlacedCamera placed;
  placed.camera.name = "framed";
  placed.camera.yfov = 0.7f;
  placed.camera.aspect_ratio = aspect_ratio;
  const glm::vec3 center = 0.5f * (pose.bounds_min + pose.bounds_max);
  const float radius = 0.5f * glm::length(pose.bounds_max - pose.bounds_min);
  const glm::vec3 half = radius > 0.0f ? 0.5f * (pose.bounds_max - pose.bounds_min) : glm::vec3(1.0f);

  // From the front, a little from the right and from above: three sides of a box are seen.
  const glm::vec3 back = glm::normalize(glm::vec3(0.5f, 0.45f, 1.0f));
  const glm::vec3 right = glm::normalize(glm::cross({0.0f, 1.0f, 0.0f}, back));
  const glm::vec3 up = glm::cross(back, right);

  // A point is inside the frustum of an eye at e when |p.x - e.x| <= (e.z - p.z) * tan_x, likewise in y: linear in e,
  // so the nearest eye that sees all eight corners has a closed form in each axis.
  constexpr float kFilled = 0.94f;  // the rest is margin
  const float tan_y = kFilled * std::tan(0.5f * placed.camera.yfov);
  const glm::vec2 tangent(tan_y * std::max(aspect_ratio, 1e-3f), tan_y);
  glm::vec2 high(-std::numeric_limits<float>::max()), low(std::numeric_limits<float>::max());
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 offset = half * glm::vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const glm::vec2 across(glm::dot(offset, right), glm::dot(offset, up));
    const float depth = glm::dot(offset, back);
    high = glm::max(high, across + depth * tangent);
    low = glm::min(low, across - depth * tangent);
  }
  const glm::vec2 distance = (high - low) / (2.0f * tangent);
  const glm::vec2 across = 0.5f * (high + low);
  const float away = std::max(distance.x, distance.y);
  const glm::vec3 eye = center + across.x * right + across.y * up + away * back;
  placed.camera.znear = 0.01f * glm::length(half);
  placed.world_from_view =
      glm::mat4(glm::vec4(right, 0.0f), glm::vec4(up, 0.0f), glm::vec4(back, 0.0f), glm::vec4(eye, 1.0f));
  return placed;
}

}  // namespace lightwell
