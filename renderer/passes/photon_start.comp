// Photons begin at lights, aimed at points of mirrors (renderer/passes/photon_targets.h).
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/ray.glsl"
#ifdef HAS_TEXTURES
#include "shaders/textures.glsl"
#endif
#include "shaders/lights.glsl"
#include "shaders/environment.glsl"
#include "shaders/light_sampling.glsl"
#include "shaders/next_event.glsl"

layout(binding = UNIT_PHOTON_TARGETS) uniform samplerBuffer targets;  // 2 texels a target
layout(std430, binding = BINDING_PHOTON_RAYS) writeonly buffer Rays { vec4 rays[]; };  // 2 a ray
layout(std430, binding = BINDING_PHOTON_FLUXES) writeonly buffer Fluxes { vec4 fluxes[]; };

uniform uint photon_count;
uniform uint seed;
uniform float beyond_scene_m;  // from how far lights shine that are infinitely far

void main() {
  const uint index = gl_GlobalInvocationID.x;
  if (index >= photon_count) return;
  const vec4 target = texelFetch(targets, int(2u * index));
  const vec3 normal_ws = texelFetch(targets, int(2u * index + 1u)).xyz;
  const vec2 u_choices = sobol_2d(index, hash(seed + 1u));
  const TableSample at = sample_light(target.xyz, false, sobol_2d(index, hash(seed)), u_choices.x, u_choices.y);
  const float distance_m = min(at.distance_m, beyond_scene_m);
  const vec3 flux = at.value * (abs(dot(normal_ws, at.to_light_ws)) * target.w);
  const bool lit = greatest(flux) > 0.0 && distance_m > 0.0;
  // From just before the lamp, which the photon would meet.
  rays[2u * index] = vec4(target.xyz + at.to_light_ws * distance_m, 1e-4 * distance_m);
  rays[2u * index + 1u] = vec4(-at.to_light_ws, lit ? 1.001 * distance_m : -1.0);
  fluxes[index] = vec4(flux, 0.0);
}
