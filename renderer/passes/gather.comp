// Renders the indirect lighting map (thesis 4.2, Algorithm 2): the light of a pixel's hits, weighted by its BRDF.
// Corrected: 1/N sum f cos L / pdf, the BRDF being the pixel's and the pdf the patch's that its directions come from.
// SUMMED: the sum is made already, by HostGatherPass.
// GUIDE: the first batch brings what the filter and the view of distances need.
// LITERAL: the plain sum of what hit_light.comp weighted as printed, over r^2.
// The map holds light over directional albedo, so that textures do not pass through its low resolution.
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/indirect_map.glsl"
#include "shaders/environment.glsl"
#include "shaders/receiver.glsl"

#ifdef SUMMED
layout(binding = UNIT_ARRIVING) uniform samplerBuffer sums;  // a slot: the sum of all batches, the mean distance
#else
layout(binding = UNIT_HITS) uniform usamplerBuffer hit_words;  // 5 texels a hit, distance first
layout(binding = UNIT_ARRIVING) uniform samplerBuffer arriving;  // radiance of the hits
layout(binding = UNIT_DIRECTIONS) uniform samplerBuffer directions;  // of the patches, with their pdf
#endif
layout(rgba32f, binding = 0) uniform image2D indirect_map;  // premultiplied by validity in a
#ifdef GUIDE
layout(r32f, binding = 1) uniform image2D occlusion_distance;  // mean distance of the hits, metres
layout(rgba32ui, binding = 2) writeonly uniform uimage2D guide;  // what the filter compares, see indirect_filter.comp
#endif

uniform uint direction_count;  // in this batch
uniform uint total_directions; // in all batches
uniform int first_batch;
uniform float environment_share;  // 1 in the bounce to which misses bring light from beyond the scene, else 0
uniform uint patch_count;

#ifdef SUMMED
// xyz: the sum over the directions; w: the mean distance of the hits, metres.
vec4 gathered(GBufferPoint point, uint slot) { return slot == kNoRank ? vec4(0.0) : texelFetch(sums, int(slot)); }
#else
#ifdef CLEAR_SURFACES
layout(binding = UNIT_CLEARED) uniform samplerBuffer cleared;  // see clear_hits.comp
vec3 light_of_miss(int record, vec3 environment) {
  return environment * texelFetch(cleared, 2 * record).rgb + texelFetch(cleared, 2 * record + 1).rgb;
}
#else
vec3 light_of_miss(int record, vec3 environment) { return environment; }
#endif

#ifdef PATCHES
layout(binding = UNIT_PIXEL_ORIGINS) uniform usamplerBuffer pixel_origins;
uint patch_of_slot(uint slot) {
  const uint patch_index = texelFetch(pixel_origins, int(2u * slot)).w;
  return patch_index == kNoRank ? 0u : patch_index;  // background, which gathers nothing
}
#else
uint patch_of_slot(uint slot) { return slot; }
#endif

Receiver receiver_at(GBufferPoint point) {
  const mat3 frame = frame_around(point.normal_ws);
  return Receiver(brdf_in_frame(point.brdf, frame), frame, point.to_camera_ws * frame, point.geometric_normal_ws);
}

// Light along a direction with a hit at `t` metres, or none where that is negative, times its weight.
#ifdef LITERAL
vec3 light_from(Receiver receiver, int record, vec4 direction, float t) {
  return t >= 0.0 ? texelFetch(arriving, record).rgb / max(t * t, 1e-12) : vec3(0.0);
}
#else
vec3 light_from(Receiver receiver, int record, vec4 direction, float t) {
  const vec3 beyond = light_of_miss(record, environment_radiance(direction.xyz)) * environment_share;
  return weight_of(receiver, direction.xyz, direction.w) * (t >= 0.0 ? texelFetch(arriving, record).rgb : beyond);
}
#endif

vec4 gathered(GBufferPoint point, uint slot) {
  const Receiver receiver = receiver_at(point);
  const uint patch_index = patch_of_slot(slot == kNoRank ? 0u : slot);
  vec3 sum = vec3(0.0);
  vec2 distance_sum = vec2(0.0);
  const uint count = slot == kNoRank ? 0u : direction_count;
  for (uint j = 0u; j < count; ++j) {
    const int record = int(j * slot_count + slot);
    const vec4 direction = texelFetch(directions, int(j * patch_count + patch_index));
    const float t = uintBitsToFloat(texelFetch(hit_words, 5 * record).x);
    sum += light_from(receiver, record, direction, t);
    distance_sum += t >= 0.0 ? vec2(t, 1.0) : vec2(0.0);
  }
  return vec4(sum, distance_sum.y > 0.0 ? distance_sum.x / distance_sum.y : 0.0);
}
#endif

void main() {
  const ivec2 map_pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(map_pixel, indirect_size_px))) return;
  const uint slot = slot_of_pixel(map_pixel);
  const GBufferPoint point = g_buffer_point(representative_pixel(map_pixel));
  const float cos_out = max(dot(point.normal_ws, point.to_camera_ws), 0.0);

  const vec4 light = gathered(point, slot);
  vec3 sum = light.xyz;
#ifndef LITERAL
  sum /= float(total_directions);
#endif
  const vec3 albedo = max(directional_albedo(point.brdf, cos_out), vec3(1e-4));
  const vec3 demodulated = point.valid ? sum / albedo : vec3(0.0);
#ifdef SUMMED
  const vec4 before = vec4(0.0);
#else
  const vec4 before = first_batch == 1 ? vec4(0.0) : imageLoad(indirect_map, map_pixel);
#endif
  imageStore(indirect_map, map_pixel, vec4(before.rgb + demodulated, point.valid ? 1.0 : 0.0));
#ifdef GUIDE
  if (first_batch == 0) return;
  imageStore(occlusion_distance, map_pixel, vec4(light.w));
  imageStore(guide, map_pixel,
             uvec4(floatBitsToUint(point.position_ws), pack_normal_roughness(point.normal_ws, sqrt(point.brdf.alpha))));
#endif
}
