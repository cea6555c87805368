// The camera that `render` looks through.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "renderer/error.h"
#include "renderer/scene/pose.h"

namespace lightwell {

/// One of the scene's cameras by index, or a place of one's own, or neither: the scene's first, else one that shows
/// all.
struct CameraArgument {
  std::optional<int> index;
  std::optional<glm::vec3> eye, target;  // both or none
  double yfov_degrees = 45.0;            // of eye and target
};

/// Errors name the option: an index that the scene does not have, an eye that is its target.
Result<PlacedCamera> place_camera(const CameraArgument& argument, const Pose& pose, float aspect_ratio);

}  // namespace lightwell
