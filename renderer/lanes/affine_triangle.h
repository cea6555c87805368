// Triangles and directions for the kernels of renderer/lanes/patch_light.h. Not for files that are compiled for a kind
// of processor.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "renderer/lanes/patch_light.h"

namespace lightwell::lanes {

inline void assign(float (&to)[3], glm::vec3 from) {
  to[0] = from.x, to[1] = from.y, to[2] = from.z;
}

inline glm::vec3 along(const PatchDirection& direction) {
  return {direction.direction_ws[0], direction.direction_ws[1], direction.direction_ws[2]};
}

inline AffineTriangle affine_triangle(const std::array<glm::vec3, 3>& corners, glm::vec3 direction) {
  const glm::vec3 b = corners[1] - corners[0], c = corners[2] - corners[0];
  const glm::vec3 across = glm::cross(direction, c);
  const float inverse = 1.0f / glm::dot(b, across);  // infinite for a ray in the plane: nothing compares true with NaN
  AffineTriangle affine;
  assign(affine.corner, corners[0]);
  assign(affine.u, across * inverse);
  assign(affine.v, glm::cross(b, direction) * inverse);
  assign(affine.t, glm::cross(b, c) * inverse);
  return affine;
}

}  // namespace lightwell::lanes
