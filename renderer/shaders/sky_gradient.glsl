// The sky without a picture. Compiles for lanes as well, see shaders/select.glsl.
#include "shaders/select.glsl"

// `up` is the direction's y.
vec3 sky_gradient(vec3 zenith_radiance, vec3 horizon_radiance, vec3 ground_radiance, float up) {
  const vec3 sky = mix(horizon_radiance, zenith_radiance, sqrt(max(up, 0.0)));
  const vec3 below = mix(horizon_radiance, ground_radiance, smoothstep(0.0, 0.15, -up));
  return select(up >= 0.0, sky, below);
}
