// A ray against as many triangles as there are lanes. For files that are compiled for a kind of processor: see
// renderer/lanes/glsl.h.
#pragma once

#include "renderer/lanes/parallel_rays.h"

namespace lightwell::lanes {
namespace {

// False for a ray that is off or not finite.
bool is_active(const SingleRay& ray) {
  bool is_finite = true;
  for (int axis = 0; axis < 3; ++axis)
    is_finite &=
        ray.origin_ws[axis] - ray.origin_ws[axis] == 0.0f && ray.direction_ws[axis] - ray.direction_ws[axis] == 0.0f;
  return is_finite && ray.t_max >= ray.t_min;
}

// Keeps the nearest hit.
class SingleRayLeaf {
 public:
  SingleRayLeaf(const SingleRay& ray, SingleHit& hit)
      : hit_(hit), origin_(all_lanes(ray.origin_ws)), direction_(all_lanes(ray.direction_ws)), t_min_(ray.t_min) {}

  // The distance of the nearest hit so far.
  float try_leaf(const WideLeaf& leaf, float far) {
    for (int first = 0; first < kWide; first += kLanes) {
      const vec3 normal = load_wide(leaf.normal, first);
      const Float inverse = 1.0f / -dot(normal, direction_);
      const vec3 way = origin_ - load_wide(leaf.corner, first);
      const vec3 across = cross(way, direction_);
      // As AffineTriangle has it: dot(way, cross(direction, c)) = dot(c, cross(way, direction)).
      const Float u = dot(load_wide(leaf.to_third, first), across) * inverse;
      const Float v = -dot(load_wide(leaf.to_second, first), across) * inverse;
      const Float t = dot(way, normal) * inverse;
      const Mask met =
          u >= -kEdgeTolerance && v >= -kEdgeTolerance && u + v <= 1.0f + kEdgeTolerance && t > t_min_ && t < far;
      if (!any(met)) continue;
      const Float distance = select(met, t, kNothing);
      far = least_lane(distance);
      const int lane = __builtin_ctz(lane_bits(distance <= far));
      hit_ = {far, leaf.instance[first + lane], leaf.triangle[first + lane], clamp_lane(u, lane), clamp_lane(v, lane)};
    }
    return far;
  }

 private:
  static float clamp_lane(Float lanes, int lane) { return lanes.v[lane] > 0.0f ? lanes.v[lane] : 0.0f; }

  SingleHit& hit_;
  const vec3 origin_, direction_;
  const float t_min_;
};

}  // namespace
}  // namespace lightwell::lanes
