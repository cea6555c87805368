// Shadow rays through clear surfaces: a ray that has met one goes on, and the light that waits for it is tinted; one that
// has met anything else brings nothing.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/ray.glsl"
#include "shaders/textures.glsl"
#include "shaders/surface.glsl"
#include "shaders/hit_surface.glsl"
#include "shaders/clear_hit.glsl"
#include "shaders/fetch_hit.glsl"

layout(std430, binding = BINDING_RAYS) writeonly buffer Rays { Ray rays[]; };  // those of fetch_ray()
layout(std430, binding = BINDING_ARRIVING) buffer Light { vec4 light[]; };     // a is not light
layout(std430, binding = BINDING_OUTPUT) buffer Count { uint onward_count; };

uniform uint ray_count;
uniform int goes_on;       // 0: no further surface lets light through
uniform uint clear_flags;  // of what does
// Light of ray i: light[first + stride * i], from ray `split` on light[first_of_rest + i - split].
uniform uvec4 light_places;  // first, stride, split, first_of_rest

uint place_of_light(uint ray) {
  return ray < light_places.z ? light_places.x + light_places.y * ray : light_places.w + ray - light_places.z;
}

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= ray_count) return;
  Ray ray = fetch_ray(int(index));
  if (ray.t_max < ray.t_min) return;
  const Hit hit = fetch_hit(int(index));
  vec3 passed = vec3(hit.t < 0.0 ? 1.0 : 0.0);
  if (goes_on == 1 && is_clear(hit, clear_flags)) passed = passed_straight(ray, hit, hit_point(ray, hit, 0.0));
  const bool onward = hit.t >= 0.0 && max(passed.r, max(passed.g, passed.b)) > 0.0;
  if (hit.t >= 0.0) light[place_of_light(index)].rgb *= passed;
  if (onward) {
    ray = past_surface(ray, hit);
    atomicAdd(onward_count, 1u);
  }
  rays[index].t_min = ray.t_min;
  rays[index].t_max = onward ? ray.t_max : -1.0;
}
