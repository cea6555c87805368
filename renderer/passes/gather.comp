// Renders the indirect lighting map (thesis 4.2, Algorithm 2): the light of a pixel's hits, weighted by its BRDF.
// Corrected: 1/N sum f cos L / pdf. LITERAL: the plain sum of what hit_light.comp weighted as printed, over r^2.
// The map holds light over directional albedo, so that textures do not pass through its low resolution.
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/indirect_map.glsl"
#include "shaders/arriving.glsl"
#include "shaders/environment.glsl"

#ifdef LITERAL
layout(binding = UNIT_HITS) uniform usamplerBuffer hit_words;  // 5 texels a hit, distance first
#endif
layout(binding = UNIT_ARRIVING) uniform usamplerBuffer arriving;
layout(rgba32f, binding = 0) uniform image2D indirect_map;  // premultiplied by validity in a
layout(r32f, binding = 1) uniform image2D occlusion_distance;  // mean distance of the hits, metres
layout(rgba32ui, binding = 2) writeonly uniform uimage2D guide;  // what the filter compares, see indirect_filter.comp

uniform uint direction_count;  // in this batch
uniform uint total_directions; // in all batches
uniform int first_batch;
uniform float environment_share;  // 1 in the bounce to which misses bring the environment, else 0

#ifdef LITERAL
vec3 light_from(int ray, uvec4 light) {
  const float t = uintBitsToFloat(texelFetch(hit_words, 5 * ray).x);
  return is_lit(light) ? color_of(light) / max(t * t, 1e-12) : vec3(0.0);
}
#else
vec3 light_from(int ray, uvec4 light) {
  const vec3 environment = environment_radiance(direction_of_unlit(light)) * environment_share;
  return color_of(light) * (is_lit(light) ? vec3(1.0) : environment);
}
#endif

void main() {
  const ivec2 map_pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(map_pixel, indirect_size_px))) return;
  const uint slot = slot_of_pixel(map_pixel);
  const GBufferPoint point = g_buffer_point(representative_pixel(map_pixel));
  const float cos_out = max(dot(point.normal_ws, point.to_camera_ws), 0.0);

  vec3 sum = vec3(0.0);
  vec2 distance_sum = vec2(0.0);
  const uint count = slot == kNoRank ? 0u : direction_count;
  for (uint j = 0u; j < count; ++j) {
    const int index = int(j * slot_count + slot);
    const uvec4 light = texelFetch(arriving, index);
    sum += light_from(index, light);
    distance_sum += is_lit(light) ? vec2(distance_of_lit(light), 1.0) : vec2(0.0);
  }
#ifndef LITERAL
  sum /= float(total_directions);
#endif
  const vec3 albedo = max(directional_albedo(point.brdf, cos_out), vec3(1e-4));
  const vec3 demodulated = point.valid ? sum / albedo : vec3(0.0);
  const vec4 before = first_batch == 1 ? vec4(0.0) : imageLoad(indirect_map, map_pixel);
  imageStore(indirect_map, map_pixel, vec4(before.rgb + demodulated, point.valid ? 1.0 : 0.0));
  if (first_batch == 0) return;
  imageStore(occlusion_distance, map_pixel, vec4(distance_sum.y > 0.0 ? distance_sum.x / distance_sum.y : 0.0));
  imageStore(guide, map_pixel,
             uvec4(floatBitsToUint(point.position_ws), pack_normal_roughness(point.normal_ws, sqrt(point.brdf.alpha))));
}
