// Direct light of lights without a size: per pixel a shadow ray to each of the OWN_RAYS strongest, so that these make no
// noise. OTHER_LIGHTS: one more ray to one of the others, chosen by what it would give here if nothing were in its way,
// of a few candidates sampled by their power (Talbot et al. 2005).
// Wide groups, for the lanes of a software device then write to places side by side.
layout(local_size_x = 16, local_size_y = 4) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/net_points.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/ray.glsl"
#include "shaders/lights.glsl"
#include "shaders/environment.glsl"
#include "shaders/light_sampling.glsl"
#include "shaders/next_event.glsl"

// All pixels' first rays, then their second ones. By four words: on a software device every store is a loop over the lanes.
layout(std430, binding = BINDING_SAMPLE_SHADOW_RAYS) writeonly buffer ShadowRays { vec4 shadow_rays[]; };  // 2 a ray
layout(std430, binding = BINDING_SAMPLE_LIGHT) writeonly buffer SampleLight { vec4 light[]; };

// What a light gives if nothing is in its way.
vec3 unshadowed(GBufferPoint point, TableSample from) {
  return brdf_times_cosine(point.brdf, point.normal_ws, point.to_camera_ws, from.to_light_ws) * from.value;
}

void send_ray(uint number, ivec2 pixel, GBufferPoint point, TableSample from, vec3 value) {
  const bool lit = point.valid && luminance(value) > 0.0;
  const float side = dot(from.to_light_ws, point.geometric_normal_ws) < 0.0 ? -1.0 : 1.0;
  const vec3 origin_ws = point.position_ws + side * ray_offset_m(point) * point.geometric_normal_ws;
  Ray ray = shadow_ray(origin_ws, point.position_ws, from);
  ray.t_max = lit ? ray.t_max : -1.0;
  const ivec2 size_px = camera.size_px.xy;
  const uint index = uint((int(number) * size_px.y + pixel.y) * size_px.x + pixel.x);
  shadow_rays[2u * index] = vec4(ray.origin_ws, ray.t_min);
  shadow_rays[2u * index + 1u] = vec4(ray.direction_ws, ray.t_max);
  light[index] = vec4(lit ? value : vec3(0.0), 0.0);
}

#if OWN_RAYS > 0
// The table's first records, as a uniform block: on a software device each load from a texture is one per lane and word.
layout(std140, binding = BINDING_STRONGEST_LIGHTS) uniform StrongestLights { uvec4 strongest_lights[4 * OWN_RAYS]; };

void send_own_rays(ivec2 pixel, GBufferPoint point) {
  for (uint i = 0u; i < uint(OWN_RAYS); ++i) {
    const uvec4 record[4] = uvec4[4](strongest_lights[4u * i], strongest_lights[4u * i + 1u],
                                     strongest_lights[4u * i + 2u], strongest_lights[4u * i + 3u]);
    const TableSample from = sample_punctual(record, 1.0, point.position_ws);
    send_ray(i, pixel, point, from, unshadowed(point, from));
  }
}
#else
void send_own_rays(ivec2 pixel, GBufferPoint point) {}
#endif

#ifdef OTHER_LIGHTS
uniform uint other_choices;  // where their alias table begins
uniform uint frame_number;
uniform uint seed;

void send_other_ray(ivec2 pixel, GBufferPoint point) {
  const uint kCandidates = 4u;
  const uint kDecisionCandidates = 0u, kDecisionTaken = 1u;
  const NetPlace place = net_place(uvec2(pixel), hash(seed ^ 0x2545f491u));
  TableSample chosen = TableSample(vec3(0.0, 1.0, 0.0), 0.0, vec3(0.0), 0.0);
  vec3 value = vec3(0.0);  // of the chosen one, over its weight
  float weights = 0.0;
  float u = net_1d(place, frame_number, kDecisionTaken);
  for (uint i = 0u; i < kCandidates; ++i) {
    const float u_candidate = net_1d(place, frame_number * kCandidates + i, kDecisionCandidates);
    const Choice choice = choose(other_choices, table_punctual_lights, u_candidate);
    const TableSample candidate = sample_chosen_light(choice, point.position_ws, vec2(0.0), 0.0);
    const vec3 given = unshadowed(point, candidate) / float(kCandidates);
    const float weight = luminance(given);
    weights += weight;
    const float share = weight / max(weights, 1e-30);
    // One random number serves all choices: what is left of it after a choice is as uniform as it was.
    const bool take = u < share && weight > 0.0;
    u = take ? u / max(share, 1e-30) : (u - share) / max(1.0 - share, 1e-30);
    if (take) {
      chosen = candidate;
      value = given / weight;
    }
  }
  send_ray(uint(OWN_RAYS), pixel, point, chosen, value * weights);
}
#else
void send_other_ray(ivec2 pixel, GBufferPoint point) {}
#endif

// Without a branch, for under one a software device reads uniform blocks once a lane; what lies outside the picture does
// its last pixel once more.
void main() {
  const ivec2 pixel = min(ivec2(gl_GlobalInvocationID.xy), camera.size_px.xy - 1);
  const GBufferPoint point = g_buffer_point(pixel);
  send_own_rays(pixel, point);
  send_other_ray(pixel, point);
}
