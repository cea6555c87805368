// Beyond the thesis: pixels of a patch that are similar to no patch around them, but to each other, share rays. Going
// through a patch's pixels in their order, each unmatched one refers to the first of up to four before it that it is
// similar to and that refers to none itself; else it will trace rays of its own. Not by the printed sign of the depths'
// test: what is unlike by it shares nothing.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/camera.glsl"
#include "shaders/indirect_map.glsl"
#include "shaders/patches.glsl"
#include "shaders/similarity.glsl"

layout(binding = UNIT_REFERENCES) uniform usamplerBuffer unmatched_references;
layout(std430, binding = BINDING_REFERENCES) writeonly buffer References { uint references[]; };  // one a slot
layout(std430, binding = BINDING_OUTPUT) writeonly buffer Owners { uint owners[]; };  // how many trace, one a patch

const uint kMostShared = 4u;

void main() {
  const uint patch_index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint first_slot = patch_index << 2 * log2_patch_side;
  if (first_slot >= slot_count) return;
  const uint end_slot = first_slot + (1u << 2 * log2_patch_side);
  const PatchPoint none = PatchPoint(false, ivec2(0), vec3(0.0), vec3(0.0), 0.0, 0u, 0.0);
  PatchPoint shared_points[kMostShared] = PatchPoint[](none, none, none, none);
  uint owner_count = 0u;
  uint slot = first_slot;
  while (true) {
    while (slot < end_slot && texelFetch(unmatched_references, int(slot)).x != kUnmatchedBit) ++slot;
    if (slot >= end_slot) break;
    uint owner = owner_count;
#ifndef LITERAL_SIMILARITY
    const PatchPoint point = point_of_pixel(pixel_of_slot(slot));
    for (uint i = kMostShared; i-- > 0u;)
      owner = i < owner_count && is_similar(point, shared_points[i]) ? i : owner;
    for (uint i = 0u; i < kMostShared; ++i)
      if (owner == owner_count && i == owner_count) shared_points[i] = point;
#endif
    references[slot] = kUnmatchedBit | (owner < owner_count ? kSharedBit : 0u) | owner;
    owner_count += owner == owner_count ? 1u : 0u;
    ++slot;
  }
  owners[patch_index] = owner_count;
}
