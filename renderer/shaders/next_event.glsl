// Light found by samples of the lights and by rays, and the rays for it. Needs ray, light_sampling.

const Ray kNoRay = Ray(vec3(0.0), 0.0, vec3(0.0, 1.0, 0.0), -1.0);

float greatest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// The share of a sample of density `own` where another strategy has density `other`: Veach's power heuristic. `other` is 0
// where it cannot find the light.
float mis_weight(float own, float other) {
  const float ratio = other / max(own, 1e-30);
  return 1.0 / (1.0 + ratio * ratio);
}

// A point lifted off its surface on the side of `direction`, well over the rounding of a hit at `distance_m`.
vec3 lifted(vec3 position_ws, vec3 geometric_normal_ws, float distance_m, vec3 direction) {
  const float offset_m = 1e-5 * (greatest(abs(position_ws)) + distance_m);
  const float side = dot(direction, geometric_normal_ws) >= 0.0 ? 1.0 : -1.0;
  return position_ws + side * offset_m * geometric_normal_ws;
}

// To just before the light: aimed from where the ray begins, for from the surface it would pierce a near light's plane
// sooner than at its end.
Ray shadow_ray(vec3 origin_ws, vec3 position_ws, TableSample at) {
  if (at.distance_m >= kInfinitelyFar) return Ray(origin_ws, 0.0, at.to_light_ws, at.distance_m);
  const vec3 to_light = position_ws + at.to_light_ws * at.distance_m - origin_ws;
  const float distance_m = length(to_light);
  return Ray(origin_ws, 0.0, to_light / max(distance_m, 1e-20), distance_m * (1.0 - 1e-4));
}
