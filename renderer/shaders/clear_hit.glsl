// Rays that meet clear surfaces. Needs hit_surface, and HAS_LOBES, which every scene with clear surfaces has.
#include "shaders/clear_surface.glsl"

// Whether the surface's material has one of `flags`: kMaterialClear or kMaterialClearWall.
bool is_clear(Hit hit, uint flags) {
  const int first = int(kMaterialTexels * fetch_instance(hit.instance).material);
  return hit.t >= 0.0 && (texelFetch(material_words, first + 3).x & flags) != 0u;
}

// What goes on of the light along a ray that has met the clear surface before at its t_min, or begins within the volume that
// absorbs it on its way.
vec3 passed_straight(Ray ray, Hit hit, HitPoint point) {
  const vec3 absorbed = pow(point.medium_transmittance, vec3((hit.t - ray.t_min) / max(hit.t, 1e-20)));
  return clear_transmittance(point.brdf, point.surface.normal_ws, ray.direction_ws) * absorbed;
}

// The rest of the ray: well over the rounding of the hit, for the surface must not be met again.
Ray past_surface(Ray ray, Hit hit) {
  const vec3 reach = abs(ray.origin_ws) + hit.t;
  return Ray(ray.origin_ws, hit.t + 1e-5 * max(reach.x, max(reach.y, reach.z)), ray.direction_ws, ray.t_max);
}
