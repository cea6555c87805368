// The sampling direction map D(p, j) (thesis 3.1): directions importance-sampled by the BRDF, each with its weight
// f cos(theta) / pdf. Rays lie direction by direction: ray = j * slot_count + slot. An invocation makes several of a
// pixel. A software device pays for every word that is stored.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/ray.glsl"
#include "shaders/indirect_map.glsl"
#include "shaders/arriving.glsl"

layout(std430, binding = BINDING_RAYS) writeonly buffer Rays { Ray rays[]; };
layout(std430, binding = BINDING_ARRIVING) writeonly buffer Arriving { uvec4 arriving[]; };

layout(binding = UNIT_SAMPLE_POINTS) uniform samplerBuffer sample_points;  // 16 a direction, see sample_points.comp

uniform uint direction_count;

const uint kDirectionsPerInvocation = 8u;

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint slot = index % slot_count;
  const uint first = index / slot_count * kDirectionsPerInvocation;
  if (first >= direction_count) return;
  const ivec2 map_pixel = pixel_of_slot(slot);
  const bool inside = all(lessThan(map_pixel, indirect_size_px));
  const GBufferPoint point = g_buffer_point(representative_pixel(min(map_pixel, indirect_size_px - 1)));
  const int place = int(slot) / 16 % 16;
  const mat3 frame = frame_around(point.normal_ws);
  const vec3 out_direction = point.to_camera_ws * frame;
  const Brdf brdf = brdf_in_frame(point.brdf, frame);
  const vec3 lift_ws = point.geometric_normal_ws * ray_offset_m(point);

  for (uint j = first; j < min(first + kDirectionsPerInvocation, direction_count); ++j) {
    const vec3 u = texelFetch(sample_points, int(16u * j) + place).xyz;
    const vec3 in_direction = sample_brdf(brdf, out_direction, u.xy, u.z);
    const vec3 in_ws = frame * in_direction;
    const float pdf = brdf_pdf(brdf, out_direction, in_direction);
    // Light that passes the surface comes from below both normals, what is reflected from above both.
    const bool below = in_direction.z < 0.0;
    const bool agree = (dot(in_ws, point.geometric_normal_ws) < 0.0) == below;
    const bool active_ray = inside && point.valid && pdf > 0.0 && agree;
    const vec3 weight =
        active_ray ? brdf_times_cosine(brdf, out_direction, in_direction) / max(pdf, 1e-20) : vec3(0.0);
    const uint ray = j * slot_count + slot;
    rays[ray].origin_ws = point.position_ws + (below ? -lift_ws : lift_ws);  // t_min stays 0
    rays[ray].direction_ws = in_ws;
    rays[ray].t_max = active_ray ? 1e30 : -1.0;
    arriving[ray] = pack_unlit(weight, in_ws);
  }
}
