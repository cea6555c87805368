// What a sample brings to its pixel of light that has bounced, over directional albedo, is scaled down to a multiple of what
// samples bring in the mean. What comes straight from lamps and the sky stays, and so does what mirrors show, for their
// pixels' rays all go to the same place. MEASURE: before that, parts of the mean.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/patch_samples.glsl"
#include "shaders/sum_samples.glsl"
#include "shaders/smooth_lobe.glsl"
#include "shaders/group_sum.glsl"

layout(std430, binding = BINDING_SAMPLE_LIGHT) writeonly buffer SampleLight { vec4 clamped[]; };  // as `light`
layout(std430, binding = BINDING_FIREFLY_PARTS) writeonly buffer Parts { vec2 parts[]; };         // one a group
layout(std430, binding = BINDING_FIREFLY_SUMS) readonly buffer Totals { float mean; };

uniform uint first_direct;
uniform uint part_count;
uniform float firefly_clamp;

const float kGreatest = 1e15;

// One infinite sample would be the mean of all.
float finite_luminance(vec3 value) { return luminance(mix(vec3(0.0), clamp(value, 0.0, kGreatest), equal(value, value))); }

#ifdef MEASURE
// Luminance over albedo; texels.
vec2 part_of(uint slot, uint texel_index, GBufferPoint point) {
  if (!point.valid) return vec2(0.0);
  const float of_ray = finite_luminance(light_of_ray(slot)) / float(rays_per_texel);
  return slot == texel_index ? vec2(of_ray + finite_luminance(light_of_lamp(slot)), 1.0) : vec2(of_ray, 0.0);
}
#else
// What a sample counts for in the picture.
vec3 light_in_picture(GBufferPoint point) {
#ifdef PIXEL_LIST
  const float pixels = 1.0;
#else
  const float pixels = pixels_per_texel.x * pixels_per_texel.y * float(1 << (log2_patch.x + log2_patch.y));
#endif
  const vec3 albedo = directional_albedo(point.brdf, max(dot(point.normal_ws, point.to_camera_ws), 0.0));
  return pixels * max(albedo, vec3(1e-4));
}

// The share of the bounced light that stays.
float kept_share(vec3 bounced, GBufferPoint point) {
#ifdef REFLECTIONS
  if (point.brdf.alpha < kMirrorAlpha) return 1.0;
#endif
  const float most = firefly_clamp * mean;
  const float light_of_sample = luminance(bounced);
  return most > 0.0 && light_of_sample > most ? most / light_of_sample : 1.0;
}

// Luminance in the picture: what is taken away; all.
vec2 part_of(uint slot, uint texel_index, GBufferPoint point) {
  if (!point.valid) return vec2(0.0);
  const vec3 direct = texelFetch(light, int(first_direct + slot)).rgb;
  const vec3 arriving = arriving_along_ray(slot), weight = texelFetch(states, int(slot)).rgb;
  const vec3 bounced = max(arriving - direct, vec3(0.0));
  const float kept = kept_share(bounced * weight, point);
  if (kept < 1.0) {
    clamped[2u * slot] = vec4(direct + kept * bounced, texelFetch(light, int(2u * slot)).a);
    clamped[2u * slot + 1u] = vec4(0.0);  // nothing waits, and no path goes on
  }
  const vec3 in_picture = light_in_picture(point), of_ray = in_picture / float(rays_per_texel);
  const float lamp = slot == texel_index ? finite_luminance(in_picture * light_of_lamp(slot)) : 0.0;
  return vec2((1.0 - kept) * finite_luminance(of_ray * weight * bounced),
              finite_luminance(of_ray * weight * arriving) + lamp);
}
#endif

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint slot = group * 64u + gl_LocalInvocationIndex;
  const uint texel_index = slot % traced_texels();
  const ivec2 texel = traced_texel(texel_index);
  vec2 part = vec2(0.0);
  if (slot < sample_count) {
    GBufferPoint point = g_buffer_point(sampled_pixel(texel));
#ifdef REFLECTIONS
    point.brdf = brdf_of_reflections(point.brdf);
#else
    point.brdf = brdf_of_map(point.brdf);
#endif
    part = part_of(slot, texel_index, point);
  }
  const vec2 sum = group_sum(part);
  if (gl_LocalInvocationIndex == 0u && group < part_count) parts[group] = sum;
}
