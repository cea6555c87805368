// Where rays go on from a surface. Needs ray.

const Ray kNoRay = Ray(vec3(0.0), 0.0, vec3(0.0, 1.0, 0.0), -1.0);

float greatest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// A point lifted off its surface on the side of `direction`, well over the rounding of a hit at `distance_m`.
vec3 lifted(vec3 position_ws, vec3 geometric_normal_ws, float distance_m, vec3 direction) {
  const float offset_m = 1e-5 * (greatest(abs(position_ws)) + distance_m);
  const float side = dot(direction, geometric_normal_ws) >= 0.0 ? 1.0 : -1.0;
  return position_ws + side * offset_m * geometric_normal_ws;
}
