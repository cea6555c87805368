// Compiles for lanes as well, see shaders/select.glsl.
#include "shaders/select.glsl"

// The shading normal bent as little as it takes for its mirror direction to leave the surface, so that neither a normal
// map nor interpolation makes a pixel black at grazing angles: Keller et al. 2017, "The Iray light transport simulation
// and rendering system". `geometric_normal_ws` is unit and on the viewer's side; the result is as well.
vec3 visible_shading_normal(vec3 normal_ws, vec3 geometric_normal_ws, vec3 to_viewer_ws) {
  const float kLeastCosine = 0.01;
  const vec3 mirrored = reflect(-to_viewer_ws, normal_ws);
  const float cosine = dot(mirrored, geometric_normal_ws);
  const vec3 bent = normalize(to_viewer_ws + normalize(mirrored + (kLeastCosine - cosine) * geometric_normal_ws));
  return select(cosine >= kLeastCosine, normal_ws, bent);
}
