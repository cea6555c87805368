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

layout(std430, binding = BINDING_SAMPLE_SHADOW_RAYS) writeonly buffer ShadowRays { Ray shadow_rays[]; };
layout(std430, binding = BINDING_SAMPLE_LIGHT) writeonly buffer SampleLight { vec4 light[]; };

uniform uint frame_number;
uniform uint seed;

#ifdef EXACT_LIGHTS
const int kCandidates = EXACT_LIGHTS;
#else
const int kCandidates = 4;
#endif

#ifdef EXACT_LIGHTS
// The table's first records, read by constant indices: on a software device a variable one costs a load per invocation.
layout(std140, binding = BINDING_EXACT_LIGHTS) uniform ExactLights { uvec4 exact_lights[4 * EXACT_LIGHTS]; };
#endif

TableSample candidate(int i, vec3 position_ws, uint pixel_seed) {
#ifdef EXACT_LIGHTS
  const uvec4 record[4] =
      uvec4[4](exact_lights[4 * i], exact_lights[4 * i + 1], exact_lights[4 * i + 2], exact_lights[4 * i + 3]);
  return sample_punctual(record, 1.0, position_ws);
#else
  const float u = sobol_1d(frame_number * uint(kCandidates) + uint(i), pixel_seed);
  TableSample light = sample_light(position_ws, true, vec2(0.0), u, 0.0);
  light.value /= float(kCandidates);
  return light;
#endif
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, camera.size_px.xy))) return;
  const uint index = uint(pixel.y * camera.size_px.x + pixel.x);
  const GBufferPoint point = g_buffer_point(pixel);
  const uint pixel_seed = hash(uvec3(pixel, seed));
  float u = unit_interval(hash(pixel_seed + frame_number * 0x9e3779b9u));
  vec3 chosen = vec3(0.0);
  float chosen_weight = 0.0, weights = 0.0;
  TableSample chosen_light = TableSample(vec3(0.0, 1.0, 0.0), 0.0, vec3(0.0), 0.0);
  for (int i = 0; i < kCandidates; ++i) {
    const TableSample light = candidate(i, point.position_ws, pixel_seed);
    const vec3 value =
        brdf_times_cosine(point.brdf, point.normal_ws, point.to_camera_ws, light.to_light_ws) * light.value;
    const float weight = luminance(value);
    weights += weight;
    const float share = weight / max(weights, 1e-30);
    // One random number serves all choices: what is left of it after a choice is as uniform as it was.
    const bool take = u < share && weight > 0.0;
    u = take ? u / max(share, 1e-30) : (u - share) / max(1.0 - share, 1e-30);
    if (take) {
      chosen = value;
      chosen_weight = weight;
      chosen_light = light;
    }
  }
  const bool lit = point.valid && chosen_weight > 0.0;
  const float side = dot(chosen_light.to_light_ws, point.geometric_normal_ws) < 0.0 ? -1.0 : 1.0;
  const vec3 origin_ws = point.position_ws + side * ray_offset_m(point) * point.geometric_normal_ws;
  Ray ray = kNoRay;
  if (lit) ray = shadow_ray(origin_ws, point.position_ws, chosen_light);
  shadow_rays[index] = ray;
  light[index] = vec4(lit ? chosen * (weights / chosen_weight) : vec3(0.0), 0.0);
}
