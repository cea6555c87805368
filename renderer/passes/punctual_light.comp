// Direct light of lights without a size: per pixel one light and its shadow ray. The light is chosen by what it would give
// here if nothing were in its way, so that where one light reaches there is no noise at all.
// EXACT_LIGHTS n: all n are looked at; without it a few candidates, sampled by their power (Talbot et al. 2005).
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/ray.glsl"
#include "shaders/lights.glsl"
#include "shaders/environment.glsl"
#include "shaders/light_sampling.glsl"
#include "shaders/next_event.glsl"

// By four words: on a software device every store is a loop over the lanes.
layout(std430, binding = BINDING_SAMPLE_SHADOW_RAYS) writeonly buffer ShadowRays { vec4 shadow_rays[]; };  // 2 a ray
layout(std430, binding = BINDING_SAMPLE_LIGHT) writeonly buffer SampleLight { vec4 light[]; };

uniform uint frame_number;
uniform uint seed;

// A light chosen among those seen so far, each with the share of its weight in theirs.
struct Reservoir {
  TableSample light;
  vec3 value;    // of the chosen one
  float weight;
  float weights; // of all
  float u;
};

void consider(inout Reservoir kept, GBufferPoint point, TableSample light) {
  const vec3 value =
      brdf_times_cosine(point.brdf, point.normal_ws, point.to_camera_ws, light.to_light_ws) * light.value;
  const float weight = luminance(value);
  kept.weights += weight;
  const float share = weight / max(kept.weights, 1e-30);
  // One random number serves all choices: what is left of it after a choice is as uniform as it was.
  const bool take = kept.u < share && weight > 0.0;
  kept.u = take ? kept.u / max(share, 1e-30) : (kept.u - share) / max(1.0 - share, 1e-30);
  if (take) {
    kept.value = value;
    kept.weight = weight;
    kept.light = light;
  }
}

#ifdef EXACT_LIGHTS
// The table's first records, read by constant indices: on a software device one that a loop counts up costs a load per
// lane and word.
layout(std140, binding = BINDING_EXACT_LIGHTS) uniform ExactLights { uvec4 exact_lights[4 * EXACT_LIGHTS]; };
#define EXACT_LIGHT(i) \
  sample_punctual(     \
      uvec4[4](exact_lights[4 * i], exact_lights[4 * i + 1], exact_lights[4 * i + 2], exact_lights[4 * i + 3]), 1.0, \
      point.position_ws)

void consider_lights(inout Reservoir kept, GBufferPoint point, uint pixel_seed) {
  consider(kept, point, EXACT_LIGHT(0));
#if EXACT_LIGHTS > 1
  consider(kept, point, EXACT_LIGHT(1));
#endif
#if EXACT_LIGHTS > 2
  consider(kept, point, EXACT_LIGHT(2));
#endif
#if EXACT_LIGHTS > 3
  consider(kept, point, EXACT_LIGHT(3));
#endif
}
#else
void consider_lights(inout Reservoir kept, GBufferPoint point, uint pixel_seed) {
  const uint kCandidates = 4u;
  for (uint i = 0u; i < kCandidates; ++i) {
    const float u = sobol_1d(frame_number * kCandidates + i, pixel_seed);
    TableSample light = sample_light(point.position_ws, true, vec2(0.0), u, 0.0);
    light.value /= float(kCandidates);
    consider(kept, point, light);
  }
}
#endif

// Without a branch, for under one a software device reads uniform blocks once a lane; what lies outside the picture does
// its last pixel once more.
void main() {
  const ivec2 pixel = min(ivec2(gl_GlobalInvocationID.xy), camera.size_px.xy - 1);
  const GBufferPoint point = g_buffer_point(pixel);
  const uint pixel_seed = hash(uint(pixel.y << 16 | pixel.x) ^ hash(seed));
  Reservoir kept = Reservoir(TableSample(vec3(0.0, 1.0, 0.0), 0.0, vec3(0.0), 0.0), vec3(0.0), 0.0, 0.0,
                             unit_interval(hash(pixel_seed + frame_number * 0x9e3779b9u)));
  consider_lights(kept, point, pixel_seed);
  const bool lit = point.valid && kept.weight > 0.0;
  const float side = dot(kept.light.to_light_ws, point.geometric_normal_ws) < 0.0 ? -1.0 : 1.0;
  const vec3 origin_ws = point.position_ws + side * ray_offset_m(point) * point.geometric_normal_ws;
  Ray ray = shadow_ray(origin_ws, point.position_ws, kept.light);
  ray.t_max = lit ? ray.t_max : -1.0;
  const uint index = uint(pixel.y * camera.size_px.x + pixel.x);
  shadow_rays[2u * index] = vec4(ray.origin_ws, ray.t_min);
  shadow_rays[2u * index + 1u] = vec4(ray.direction_ws, ray.t_max);
  light[index] = vec4(lit ? kept.value * (kept.weights / kept.weight) : vec3(0.0), 0.0);
}
