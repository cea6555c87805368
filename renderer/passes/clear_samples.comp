// Rays of samples that meet a clear surface: by chance they go straight on, and the hit behind it takes its place, or they
// end there, at what it reflects. FIRST: the hits are those of the samples' rays; without it those of the rays that went on.
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

layout(std430, binding = BINDING_HITS) writeonly buffer Hits { uint hits[]; };  // the samples', 5 words a hit
layout(std430, binding = BINDING_RAYS) writeonly buffer Onward { vec4 onward[]; };  // 2 a ray
layout(std430, binding = BINDING_ARRIVING) buffer Tints { vec4 tints[]; };  // what the light along the ray is to be multiplied by
layout(std430, binding = BINDING_OUTPUT) buffer Count { uint onward_count; };

uniform uint sample_count;
uniform int goes_on;  // 0: no further surface lets light through
uniform uint surface;
uniform uint frame_number;

const float kFootprintPerMetre = 0.1;  // as in sample_hits.comp

// By the direction, for the sample's place may be another in every run.
float chance(Ray ray) {
  return unit_interval(hash(floatBitsToUint(ray.direction_ws) + hash(frame_number * 16u + surface)));
}

void write_hit(uint index, Hit hit) {
  hits[5u * index] = floatBitsToUint(hit.t);
  hits[5u * index + 1u] = hit.instance;
  hits[5u * index + 2u] = hit.triangle;
  hits[5u * index + 3u] = floatBitsToUint(hit.u);
  hits[5u * index + 4u] = floatBitsToUint(hit.v);
}

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= sample_count) return;
  const Ray ray = fetch_ray(int(index));
  const Hit hit = fetch_hit(int(index));
#ifdef FIRST
  vec3 tint = vec3(1.0);
#else
  if (ray.t_max < ray.t_min) return;
  vec3 tint = tints[index].rgb;
  write_hit(index, hit);
#endif
  Ray next = Ray(vec3(0.0), 0.0, vec3(0.0, 1.0, 0.0), -1.0);
  if (goes_on == 1 && is_clear(hit, kMaterialClear)) {
    const vec3 passed = passed_straight(ray, hit, hit_point(ray, hit, hit.t * kFootprintPerMetre));
    // Some stay even where nearly all passes, for a pane's reflection may be bright.
    const float share = clamp(max(passed.r, max(passed.g, passed.b)), 0.0, 0.9);
    const bool passes = chance(ray) < share;
    tint *= passes ? passed / share : vec3(1.0 / (1.0 - share));
    if (passes) {
      next = past_surface(ray, hit);
      atomicAdd(onward_count, 1u);
    }
  }
  tints[index] = vec4(tint, 0.0);
  onward[2u * index] = vec4(next.origin_ws, next.t_min);
  onward[2u * index + 1u] = vec4(next.direction_ws, next.t_max);
}
