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

layout(std430, binding = BINDING_RAYS) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = BINDING_HITS) readonly buffer Hits { Hit hits[]; };
layout(std430, binding = BINDING_HIT_RADIANCE) writeonly buffer HitRadiance { uvec2 hit_radiance[]; };
layout(binding = UNIT_IMAGE_A) uniform sampler2D previous_bounce;  // demodulated indirect map

uniform uint ray_count;

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

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= ray_count) return;
  const float t = hits[index].t;
  vec3 radiance = t < 0.0 ? vec3(0.0) : screen_radiance(rays[index].origin_ws + t * rays[index].direction_ws);
  radiance = min(radiance, vec3(65504.0));
  hit_radiance[index] = uvec2(packHalf2x16(radiance.rg), packHalf2x16(vec2(radiance.b, 0.0)));
}
