// What a path's ray and its shadow ray found beyond surfaces: the light of a sampled lamp whose shadow ray got through, and
// that of the environment where the path leaves the scene.
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
#include "shaders/light_strategy.glsl"
#include "shaders/fetch_hit.glsl"
#include "shaders/path.glsl"

layout(binding = UNIT_PATH_STATES) uniform samplerBuffer states;
layout(binding = UNIT_PATH_PENDING) uniform usamplerBuffer pending;
layout(binding = UNIT_PATH_VISIBLE) uniform usamplerBuffer visible;   // a bit a slot
layout(binding = UNIT_PATH_RADIANCE) uniform samplerBuffer radiance_before;  // as it was
layout(std430, binding = BINDING_PATH_RADIANCE) writeonly buffer Radiance { vec4 radiance[]; };

uniform uint path_count;

vec4 light_beyond(int slot, uint depth, vec3 direction_ws, vec4 before) {
  const vec4 state = texelFetch(states, slot);
  if (depth == 0u) return unlit_light(background_radiance(direction_ws), state.xyz, 0.0, before);
#ifdef LIGHTS_ENVIRONMENT
  const float weight = weight_of_found_light(state.w, environment_pdf(direction_ws));
  return shown_light(state.xyz * environment_radiance(direction_ws) * weight, false);
#else
  return vec4(0.0);
#endif
}

void main() {
  const uint slot = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (slot >= path_count) return;
  const uvec4 light = texelFetch(pending, int(slot));
  const bool lit = (texelFetch(visible, int(slot / 32u)).x >> (slot & 31u) & 1u) != 0u;
  const uint pixel = path_pixel(light.w);
  const vec4 before = texelFetch(radiance_before, int(pixel));
  vec4 found = lit ? shown_light(uintBitsToFloat(light.xyz), (light.w & kDirectLight) != 0u) : vec4(0.0);
  const Ray ray = fetch_ray(int(slot));
  if (ray.t_max > 0.0 && fetch_distance(int(slot)) < 0.0)
    found += light_beyond(int(slot), path_depth(light.w), ray.direction_ws, before);
  if (found != vec4(0.0)) radiance[pixel] = before + found;
}
