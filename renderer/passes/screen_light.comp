// Light leaving the hits for bounce n >= 2 (thesis 4.3): a hit is projected to the screen and takes the previous bounce's
// indirect light there. With a depth test: what the camera does not see gives nothing.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/ray.glsl"
#include "shaders/hit_list.glsl"
#include "shaders/occlusion_ray.glsl"

layout(std430, binding = BINDING_HITS) readonly buffer Hits { Hit hits[]; };
layout(std430, binding = BINDING_ARRIVING) writeonly buffer Arriving { vec4 arriving[]; };  // radiance
layout(binding = UNIT_IMAGE_A) uniform sampler2D previous_bounce;  // demodulated indirect map

const float kDepthTolerance = 0.02;  // relative; a seen surface's own slope within a pixel stays below it

vec3 screen_radiance(vec3 position_ws) {
  const vec4 clip = camera.clip_from_world * vec4(position_ws, 1.0);
  if (clip.w <= 0.0) return vec3(0.0);
  const vec2 uv = clip.xy / clip.w * 0.5 + 0.5;
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return vec3(0.0);
  const GBufferPoint seen = g_buffer_point(ivec2(uv * vec2(camera.size_px.xy)));
  const float hit_depth_m = dot(position_ws - camera.eye_ws.xyz, camera.forward_ws.xyz);
  if (!seen.valid || abs(hit_depth_m - seen.view_depth_m) > kDepthTolerance * seen.view_depth_m) return vec3(0.0);
  const vec4 demodulated = textureLod(previous_bounce, uv, 0.0);
  const float cos_out = max(dot(seen.normal_ws, seen.to_camera_ws), 0.0);
  return demodulated.rgb / max(demodulated.a, 1e-3) * directional_albedo(seen.brdf, cos_out);
}

#ifdef CLEAR_SURFACES
layout(binding = UNIT_CLEARED) uniform samplerBuffer cleared;  // see clear_hits.comp
vec3 through_clear_surfaces(uint record, vec3 light) { return light * texelFetch(cleared, int(2u * record)).rgb; }
#else
vec3 through_clear_surfaces(uint record, vec3 light) { return light; }
#endif

void main() {
  if (gl_GlobalInvocationID.x >= hit_count) return;
  const uint index = hit_ray(gl_GlobalInvocationID.x);
  const Ray ray = occlusion_ray(index);
  const vec3 light = screen_radiance(ray.origin_ws + hits[index].t * ray.direction_ws);
  arriving[index] = vec4(through_clear_surfaces(index, light), 0.0);
}
