// The sampling direction map D(p, j) (thesis 3.1): directions importance-sampled by the BRDF, each with its pdf, for the
// patches of the indirect map. Rays lie direction by direction: ray = j * patch_count + patch. An invocation makes several
// of a patch. A software device pays for every word that is stored.
// PATCHES: patches have several pixels, else each pixel is one.
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
layout(std430, binding = BINDING_DIRECTIONS) writeonly buffer Directions { vec4 directions[]; };  // pdf in w; 0: no ray

layout(binding = UNIT_SAMPLE_POINTS) uniform samplerBuffer sample_points;  // 16 a direction, see sample_points.comp

uniform uint patch_count;
uniform uint direction_count;

const uint kDirectionsPerInvocation = 8u;

struct Origin {
  GBufferPoint point;
  uint set;            // of directions
};

#ifdef PATCHES
#include "shaders/patches.glsl"
layout(binding = UNIT_PATCH_POINTS) uniform usamplerBuffer patch_points;
uniform uint first_unmatched;  // patches from here on have the seed of an unmatched pixel

Origin origin_of_patch(uint index) {
  const PatchPoint patch_point =
      unpack_patch_point(texelFetch(patch_points, int(2u * index)), texelFetch(patch_points, int(2u * index + 1u)));
  const ivec2 seed = patch_point.valid ? patch_point.seed : ivec2(0);
  GBufferPoint point = g_buffer_point(representative_pixel(seed));
  point.valid = point.valid && patch_point.valid;
  point.position_ws = patch_point.position_ws;
  point.normal_ws = patch_point.normal_ws;
  return Origin(point, direction_set(index < first_unmatched ? seed >> log2_patch_side : seed));
}
#else
Origin origin_of_patch(uint slot) {
  const ivec2 map_pixel = pixel_of_slot(slot);
  GBufferPoint point = g_buffer_point(representative_pixel(min(map_pixel, indirect_size_px - 1)));
  point.valid = point.valid && all(lessThan(map_pixel, indirect_size_px));
  return Origin(point, direction_set(map_pixel));
}
#endif

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint patch_index = index % patch_count;
  const uint first = index / patch_count * kDirectionsPerInvocation;
  if (first >= direction_count) return;
  const Origin origin = origin_of_patch(patch_index);
  const GBufferPoint point = origin.point;
  const mat3 frame = frame_around(point.normal_ws);
  const vec3 out_direction = point.to_camera_ws * frame;
  const Brdf brdf = brdf_in_frame(point.brdf, frame);
  const vec3 lift_ws = point.geometric_normal_ws * ray_offset_m(point);

  for (uint j = first; j < min(first + kDirectionsPerInvocation, direction_count); ++j) {
    const vec3 u = texelFetch(sample_points, int(16u * j + origin.set)).xyz;
    const vec3 in_direction = sample_brdf(brdf, out_direction, u.xy, u.z);
    const vec3 in_ws = frame * in_direction;
    const float pdf = brdf_pdf(brdf, out_direction, in_direction);
    // Light that passes the surface comes from below both normals, what is reflected from above both.
    const bool below = in_direction.z < 0.0;
    const bool agree = (dot(in_ws, point.geometric_normal_ws) < 0.0) == below;
    const bool active_ray = point.valid && pdf > 0.0 && agree;
    const uint ray = j * patch_count + patch_index;
    rays[ray].origin_ws = point.position_ws + (below ? -lift_ws : lift_ws);  // t_min stays 0
    rays[ray].direction_ws = in_ws;
    rays[ray].t_max = active_ray ? 1e30 : -1.0;
    directions[ray] = vec4(in_ws, active_ray ? pdf : 0.0);
  }
}
