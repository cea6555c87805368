#include "server/command_line/camera_argument.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

namespace lightwell {

namespace {

// Up is +Y; a camera that looks straight up or down has its upper edge towards -Z.
glm::mat4 world_from_view_at(const glm::vec3& eye, const glm::vec3& target) {
  const glm::vec3 forward = glm::normalize(target - eye);
  const bool vertical = std::abs(forward.y) > 0.9999f;
  return glm::inverse(glm::lookAt(eye, target, vertical ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0)));
}

}  // namespace

Result<PlacedCamera> place_camera(const CameraArgument& argument, const Pose& pose, float aspect_ratio) {
  const int camera_count = static_cast<int>(pose.cameras.size());
  if (argument.index) {
    if (*argument.index < camera_count) return pose.cameras[static_cast<std::size_t>(*argument.index)];
    return invalid_input("--camera", "there is no camera " + std::to_string(*argument.index) + ": the scene has " +
                                         std::to_string(camera_count));
  }
  if (argument.eye) {
    if (glm::distance(*argument.eye, *argument.target) < 1e-6f)
      return invalid_input("--target", "is the same point as --eye, so that there is no direction to look in");
    PlacedCamera placed;
    placed.camera.yfov = static_cast<float>(glm::radians(argument.yfov_degrees));
    const float extent = glm::distance(pose.bounds_min, pose.bounds_max);
    if (extent > 0.0f) placed.camera.znear = std::min(placed.camera.znear, 1e-3f * extent);
    placed.world_from_view = world_from_view_at(*argument.eye, *argument.target);
    return placed;
  }
  return camera_count > 0 ? pose.cameras.front() : frame_camera(pose, aspect_ratio);
}

}  // namespace lightwell
