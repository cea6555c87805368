// The reference map (thesis 5.2): each pixel of the indirect map refers to its own patch where it is similar to it, else to
// the nearest of the eight patches around that it is similar to, else to none: it will trace rays of its own.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/camera.glsl"
#include "shaders/indirect_map.glsl"
#include "shaders/patches.glsl"
#include "shaders/similarity.glsl"

layout(binding = UNIT_PATCH_POINTS) uniform usamplerBuffer patch_points;  // 2 texels a patch
layout(std430, binding = BINDING_REFERENCES) writeonly buffer References { uint references[]; };  // one a slot

PatchPoint fetch_patch(uint index) {
  return unpack_patch_point(texelFetch(patch_points, int(2u * index)), texelFetch(patch_points, int(2u * index + 1u)));
}

// The similar one among the neighbours of the pixel's patch whose seed is nearest; kNoPatch if there is none.
uint similar_neighbour(PatchPoint point, ivec2 map_pixel) {
  const ivec2 own = map_pixel >> log2_patch_side;
  uint nearest = kNoPatch;
  int least = 1 << 30;
  for (int i = 0; i < 9; ++i) {
    const ivec2 corner = own + ivec2(i % 3, i / 3) - 1 << log2_patch_side;
    const bool inside = all(greaterThanEqual(corner, ivec2(0))) && all(lessThan(corner, indirect_size_px));
    const uint slot = slot_of_pixel(inside ? corner : ivec2(0));
    if (!inside || slot == kNoRank) continue;
    const uint index = slot >> 2 * log2_patch_side;
    const PatchPoint neighbour = fetch_patch(index);
    const ivec2 way = neighbour.seed - map_pixel;
    const int distance2 = way.x * way.x + way.y * way.y;
    if (distance2 < least && is_similar(point, neighbour)) {
      least = distance2;
      nearest = index;
    }
  }
  return nearest;
}

void main() {
  const uint slot = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (slot >= slot_count) return;
  const ivec2 map_pixel = pixel_of_slot(slot);
  const PatchPoint point = point_of_pixel(map_pixel);
  uint reference = slot >> 2 * log2_patch_side;
  if (!point.valid)
    reference = kNoPatch;
  else if (!is_similar(point, fetch_patch(reference)))
    reference = similar_neighbour(point, map_pixel);
  references[slot] = point.valid && reference == kNoPatch ? kUnmatchedBit : reference;
}
