// Renders the indirect lighting map (thesis 4.2, Algorithm 2): the light of a pixel's hits, weighted by its BRDF.
// Corrected: 1/N sum f cos L / pdf. Literal: the plain sum of what hit_light.comp weighted as printed.
// The map holds light over directional albedo, so that textures do not pass through its low resolution.
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/indirect_map.glsl"

layout(binding = UNIT_HITS) uniform usamplerBuffer hit_words;  // 5 texels a hit, distance first
layout(binding = UNIT_WEIGHTS) uniform usamplerBuffer weights;
layout(binding = UNIT_HIT_RADIANCE) uniform usamplerBuffer hit_radiance;
layout(rgba32f, binding = 0) uniform image2D indirect_map;  // premultiplied by validity in a
layout(r32f, binding = 1) uniform image2D occlusion_distance;  // mean distance of the hits, metres
layout(rgba32ui, binding = 2) writeonly uniform uimage2D guide;  // what the filter compares, see indirect_filter.comp

uniform uint direction_count;  // in this batch
uniform uint total_directions; // in all batches
uniform int first_batch;
uniform int literal;

void main() {
  const ivec2 map_pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(map_pixel, indirect_size_px))) return;
  const uint slots = slot_count();
  const uint slot = slot_of_pixel(map_pixel);
  const GBufferPoint point = g_buffer_point(representative_pixel(map_pixel));
  const float cos_out = max(dot(point.normal_ws, point.to_camera_ws), 0.0);

  vec3 sum = vec3(0.0);
  vec2 distance_sum = vec2(0.0);
  for (uint j = 0u; j < direction_count; ++j) {
    const int index = int(j * slots + slot);
    const uvec2 packed_weight = texelFetch(weights, index).xy;
    const uvec2 packed_radiance = texelFetch(hit_radiance, index).xy;
    const vec3 radiance = vec3(unpackHalf2x16(packed_radiance.x), unpackHalf2x16(packed_radiance.y).x);
    const vec2 weight_zw = unpackHalf2x16(packed_weight.y);
    const float t = uintBitsToFloat(texelFetch(hit_words, 5 * index).x);
    const vec3 literal_weight = vec3(weight_zw.y / max(t * t, 1e-12));
    sum += radiance * (literal == 1 ? literal_weight : vec3(unpackHalf2x16(packed_weight.x), weight_zw.x));
    distance_sum += t >= 0.0 ? vec2(t, 1.0) : vec2(0.0);
  }
  const vec3 albedo = max(directional_albedo(point.brdf, cos_out), vec3(1e-4));
  const vec3 demodulated = point.valid ? sum / albedo * (literal == 1 ? 1.0 : 1.0 / float(total_directions)) : vec3(0.0);
  const vec4 before = first_batch == 1 ? vec4(0.0) : imageLoad(indirect_map, map_pixel);
  imageStore(indirect_map, map_pixel, vec4(before.rgb + demodulated, point.valid ? 1.0 : 0.0));
  if (first_batch == 0) return;
  imageStore(occlusion_distance, map_pixel, vec4(distance_sum.y > 0.0 ? distance_sum.x / distance_sum.y : 0.0));
  imageStore(guide, map_pixel,
             uvec4(floatBitsToUint(point.position_ws), pack_normal_roughness(point.normal_ws, sqrt(point.brdf.alpha))));
}
