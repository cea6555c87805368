// Pixels that trace rays of their own become patches, numbered after the others; and each pixel learns which patch gives it
// directions, and where its rays start. RECEIVERS: and code on the processor, what it gathers light with (PackedReceiver in renderer/passes/patches.h).
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/indirect_map.glsl"
#include "shaders/patches.glsl"

layout(std430, binding = BINDING_REFERENCES) readonly buffer References { uint references[]; };
layout(std430, binding = BINDING_OUTPUT) readonly buffer FirstOfPatch { uint first_of_patch[]; };  // number of the first
layout(std430, binding = BINDING_PATCH_POINTS) writeonly buffer PatchPoints { uvec4 patch_points[]; };
layout(std430, binding = BINDING_PIXEL_ORIGINS) writeonly buffer PixelOrigins { uvec4 pixel_origins[]; };
#ifdef RECEIVERS
layout(std430, binding = BINDING_RECEIVERS) writeonly buffer Receivers { uvec4 receivers[]; };  // 2 a slot
#endif

void main() {
  const uint slot = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (slot >= slot_count) return;
  const ivec2 map_pixel = pixel_of_slot(slot);
  const GBufferPoint point = g_buffer_point(representative_pixel(min(map_pixel, indirect_size_px - 1)));
  const uint reference = references[slot];
  const bool is_unmatched = reference != kNoPatch && (reference & kUnmatchedBit) != 0u;
  const bool is_own = is_unmatched && (reference & kSharedBit) == 0u;
  const uint own = first_of_patch[slot >> 2 * log2_patch_side] + (reference & ~(kUnmatchedBit | kSharedBit));
  const vec3 lift_ws = point.geometric_normal_ws * ray_offset_m(point);
  const uint patch_index = is_unmatched ? own : reference;
  pixel_origins[2u * slot] = uvec4(floatBitsToUint(point.position_ws + lift_ws), patch_index);
  pixel_origins[2u * slot + 1u] = uvec4(floatBitsToUint(-2.0 * lift_ws), is_own ? 1u : 0u);
#ifdef RECEIVERS
  const ivec2 seen_px = representative_pixel(min(map_pixel, indirect_size_px - 1));
  receivers[2u * slot] = texelFetch(g_surface, seen_px, 0);
  receivers[2u * slot + 1u].xyz = uvec3(texelFetch(g_material, seen_px, 0).rg,
                                        packSnorm2x16(octahedral_from_unit(point.to_camera_ws)));
#endif
  if (!is_own) return;
  // Without what similarity is judged by: that is over.
  patch_points[2u * own] = uvec4(floatBitsToUint(point.position_ws), packed_seed(map_pixel));
  patch_points[2u * own + 1u].x = packSnorm2x16(octahedral_from_unit(point.normal_ws));
}
