// Light found by samples of the lights and by rays, and the rays for it. Needs ray, light_sampling.

#include "shaders/next_ray.glsl"

// The share of a sample of density `own` where another strategy has density `other`: Veach's power heuristic. `other` is 0
// where it cannot find the light.
float mis_weight(float own, float other) {
  const float ratio = other / max(own, 1e-30);
  return 1.0 / (1.0 + ratio * ratio);
}

// To just before the light: aimed from where the ray begins, for from the surface it would pierce a near light's plane
// sooner than at its end.
Ray shadow_ray(vec3 origin_ws, vec3 position_ws, TableSample at) {
  if (at.distance_m >= kInfinitelyFar) return Ray(origin_ws, 0.0, at.to_light_ws, at.distance_m);
  const vec3 to_light = position_ws + at.to_light_ws * at.distance_m - origin_ws;
  const float distance_m = length(to_light);
  return Ray(origin_ws, 0.0, to_light / max(distance_m, 1e-20), distance_m * (1.0 - 1e-4));
}
