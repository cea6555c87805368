// The sampling direction map D(p, j) (thesis 3.1): directions importance-sampled by the BRDF, each with its weight
// f cos(theta) / pdf. Rays lie direction by direction: ray = j * pixels + pixel. An invocation makes several of a pixel.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/ray.glsl"
#include "shaders/indirect_map.glsl"

layout(std430, binding = BINDING_RAYS) writeonly buffer Rays { Ray rays[]; };
layout(std430, binding = BINDING_WEIGHTS) writeonly buffer Weights { uvec2 weights[]; };

uniform uint first_direction;
uniform uint direction_count;
uniform uint seed;

const uint kDirectionsPerInvocation = 8u;

void main() {
  const uint pixel_count = uint(indirect_size_px.x * indirect_size_px.y);
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint pixel = index % pixel_count;
  const uint first = index / pixel_count * kDirectionsPerInvocation;
  if (first >= direction_count) return;
  const ivec2 map_pixel = ivec2(int(pixel) % indirect_size_px.x, int(pixel) / indirect_size_px.x);
  const GBufferPoint point = g_buffer_point(representative_pixel(map_pixel));
  const uint pixel_seed = hash(uvec3(map_pixel, seed));
  const mat3 frame = frame_around(point.normal_ws);
  const vec3 out_direction = point.to_camera_ws * frame;
  const vec3 origin_ws = point.position_ws + point.geometric_normal_ws * ray_offset_m(point);

  for (uint j = first; j < min(first + kDirectionsPerInvocation, direction_count); ++j) {
    const uint number = first_direction + j;
    const float u_lobe = sobol_1d(number, pixel_seed ^ 0x9e3779b9u);
    const vec3 in_direction = sample_brdf(point.brdf, out_direction, sobol_2d(number, pixel_seed), u_lobe);
    const vec3 in_ws = frame * in_direction;
    const float pdf = brdf_pdf(point.brdf, out_direction, in_direction);
    const bool active_ray = point.valid && pdf > 0.0 && dot(in_ws, point.geometric_normal_ws) > 0.0;
    const vec3 weight =
        active_ray ? brdf_times_cosine(point.brdf, out_direction, in_direction) / max(pdf, 1e-20) : vec3(0.0);
    const uint slot = j * pixel_count + pixel;
    rays[slot] = Ray(origin_ws, 0.0, in_ws, active_ray ? 1e30 : -1.0);
    weights[slot] = uvec2(packHalf2x16(weight.rg), packHalf2x16(vec2(weight.b, active_ray ? 1.0 : 0.0)));
  }
}
