// What a view sees, found by one ray a pixel instead of by rasterising: of tracers that are quicker at it than the
// device where triangles outnumber pixels. No rays lie in a buffer, since all follow from a few vectors.
#pragma once

#include <glm/glm.hpp>

#include "renderer/gl/buffer.h"

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

class ViewTracer {
 public:
  virtual ~ViewTracer() = default;

  /// hits[y * width + x], as Hit: the nearest surface that a camera sees, t = kMiss where there is none. Of triangles
  /// that are not Coverage::double_sided the front alone counts. Waits for the device, which reads `hits` afterwards.
  virtual void camera_hits(const ViewRays& rays, gl::Buffer& hits) = 0;

  /// depths[y * width + x], as ViewDepth: the nearest surface, both sides of which count. Otherwise as camera_hits.
  virtual void depths(const ViewRays& rays, DepthMeasure measure, float factor, gl::Buffer& depths) = 0;
};

}  // namespace lightwell
