// What the stages before the light have found, for each pixel of the indirect map: one direction of it and its hit, the
// patch it refers to, how many candidates it has.
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/indirect_map.glsl"
#include "shaders/ray.glsl"
#include "shaders/patches.glsl"

layout(std430, binding = BINDING_HITS) readonly buffer Hits { Hit hits[]; };
layout(std430, binding = BINDING_CANDIDATES) readonly buffer Candidates { Hit candidates[]; };
layout(binding = UNIT_DIRECTIONS) uniform samplerBuffer directions;
layout(binding = UNIT_PATCH_POINTS) uniform usamplerBuffer patch_points;
layout(binding = UNIT_PIXEL_ORIGINS) uniform usamplerBuffer pixel_origins;
layout(rgba32f, binding = 0) writeonly uniform image2D view_map;

uniform int view;               // ViewKind
uniform uint direction;         // within the batch
uniform uint direction_count;   // of the batch
uniform uint patch_count;
uniform uint first_unmatched;   // patches from here on are of unmatched pixels
uniform uint group_count;       // of triangles

uint patch_of_slot(uint slot) {
#ifdef PATCHES
  return texelFetch(pixel_origins, int(2u * slot)).w;
#else
  return slot;
#endif
}

// Bright, and different for neighbours.
vec3 color_of_patch(uint index) {
  const uint bits = hash(index + 1u);
  return 0.2 + 0.7 * vec3(bits & 0xffu, bits >> 8 & 0xffu, bits >> 16 & 0xffu) / 255.0;
}

// The patch in a colour of its own; its seed, and pixels that are alone, in white.
vec3 patch_and_seed(ivec2 map_pixel, uint index) {
#ifdef PATCHES
  const PatchPoint point =
      unpack_patch_point(texelFetch(patch_points, int(2u * index)), texelFetch(patch_points, int(2u * index + 1u)));
  return point.seed == map_pixel ? vec3(1.0) : color_of_patch(index);
#else
  return color_of_patch(index);
#endif
}

// Grey: its own patch. Colours: the way to the neighbour it refers to. White: none.
vec3 reference(ivec2 map_pixel, uint slot, uint index) {
#ifdef PATCHES
  if (index >= first_unmatched) return vec3(1.0);
  const ivec2 way = (pixel_of_slot(index << 2 * log2_patch_side) >> log2_patch_side) - (map_pixel >> log2_patch_side);
  return way == ivec2(0) ? vec3(0.25) : vec3(0.5 + 0.4 * vec2(way), 0.1);
#else
  return vec3(0.25);
#endif
}

// The share of the groups of triangles in which the patch's ray has met one.
float candidate_share(uint index, uint slot) {
#ifdef PATCHES
  float count = 0.0;
  for (uint group = 0u; group < group_count; ++group)
    count += candidates[(group * direction_count + direction) * patch_count + index].t >= 0.0 ? 1.0 : 0.0;
  return count / float(group_count);
#else
  return hits[direction * slot_count + slot].t >= 0.0 ? 1.0 : 0.0;
#endif
}

void main() {
  const ivec2 map_pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(map_pixel, indirect_size_px))) return;
  const uint slot = slot_of_pixel(map_pixel);
  const uint index = slot == kNoRank ? kNoPatch : patch_of_slot(slot);
  vec3 value = vec3(0.0);
  if (index != kNoPatch) {
    switch (view) {
      case VIEW_DIRECTION: value = texelFetch(directions, int(direction * patch_count + index)).xyz; break;
      case VIEW_HIT_DISTANCE: value = vec3(max(hits[direction * slot_count + slot].t, 0.0)); break;
      case VIEW_PATCH: value = patch_and_seed(map_pixel, index); break;
      case VIEW_REFERENCE: value = reference(map_pixel, slot, index); break;
      case VIEW_CANDIDATES: value = vec3(candidate_share(index, slot)); break;
      default:
#ifdef PATCHES
        value = vec3(index >= first_unmatched ? 1.0 : 0.0);
#endif
        break;
    }
  }
  imageStore(view_map, map_pixel, vec4(value, 1.0));
}
