// What each pixel of a view looks along: rays through the pixels' middles, all of which follow from a few vectors.
#pragma once

#include <glm/glm.hpp>

namespace lightwell {

/// Rays through the middles of a view's pixels: that of pixel (x, y) starts at origin_ws + x * origin_across_ws +
/// y * origin_down_ws and goes along direction_ws + x * direction_across_ws + y * direction_down_ws. Directions need
/// not be unit vectors; t counts their length.
struct ViewRays {
  glm::vec3 origin_ws{0.0f}, origin_across_ws{0.0f}, origin_down_ws{0.0f};
  glm::vec3 direction_ws{0.0f}, direction_across_ws{0.0f}, direction_down_ws{0.0f};
  float t_min = 0.0f, t_max = 0.0f;
  glm::ivec2 size_px{0};
};

/// std430 layout; the nearest surface along a ray.
struct ViewDepth {
  float depth;   // negative: there is none
  float slope2;  // (change of depth from pixel to pixel across)^2 + (the same down)^2, along the triangle's plane
};
static_assert(sizeof(ViewDepth) == 8);

/// How a ViewDepth counts: t as it is, or the distance from the ray's origin in metres; in both cases times a factor.
enum class DepthMeasure { kAlongView, kDistance };

}  // namespace lightwell
