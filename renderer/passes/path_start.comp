// Begins a path per pixel: a ray from the camera through a point of the pixel, uniform over it (a box filter, as that of
// the other methods' accumulated frames).
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/camera.glsl"
#include "shaders/ray.glsl"
#include "shaders/path.glsl"

layout(std430, binding = BINDING_PATH_RAYS) writeonly buffer Rays { vec4 rays[]; };  // 2 a ray
layout(std430, binding = BINDING_PATH_STATES) writeonly buffer States { vec4 states[]; };
layout(std430, binding = BINDING_PATH_PENDING) writeonly buffer Pending { uvec4 pending[]; };
layout(std430, binding = BINDING_PATH_RADIANCE) writeonly buffer Radiance { vec4 radiance[]; };

uniform uint path_count;

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= path_count) return;
  const ivec2 pixel = picture_pixel(index);
  const vec2 within = sobol_2d(sample_number, decision_seed(pixel_seed(pixel), 0u, kDecisionFilter));
  const vec3 toward = camera_ray_ws(vec2(pixel) + within);
  const bool perspective = camera.eye_ws.w > 0.5;
  Ray ray;
  ray.origin_ws = perspective ? camera.eye_ws.xyz : camera.eye_ws.xyz + toward - camera.forward_ws.xyz;
  ray.direction_ws = perspective ? normalize(toward) : camera.forward_ws.xyz;
  // Nothing nearer than the near plane is seen, as in the G-buffer.
  ray.t_min = camera.right_ws.w * (perspective ? length(toward) : 1.0);
  ray.t_max = perspective ? 1e30 : camera.down_ws.w;
  rays[2u * index] = vec4(ray.origin_ws, ray.t_min);
  rays[2u * index + 1u] = vec4(ray.direction_ws, ray.t_max);
  states[index] = vec4(1.0, 1.0, 1.0, 0.0);
  pending[index] = uvec4(0u, 0u, 0u, pack_path(index, 0u, 0u));
  radiance[index] = vec4(0.0);
}
