// Where the paths are that go on, in order. SCAN turns the counts of chunks into where each chunk's begin; one work group
// does it. Without it the chunks write their slots.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/path.glsl"

layout(std430, binding = BINDING_PATH_COUNTS) buffer Counts { uint counts[]; };  // the sum first
uniform uint path_count;

#ifdef SCAN
shared uint sums[64];

void main() {
  const uint chunks = (path_count + uint(PATH_CHUNK) - 1u) / uint(PATH_CHUNK);
  const uint share = (chunks + 63u) / 64u;
  const uint lane = gl_LocalInvocationIndex;
  const uint first = 1u + lane * share, end = min(first + share, 1u + chunks);
  uint sum = 0u;
  for (uint i = first; i < end; ++i) sum += counts[i];
  sums[lane] = sum;
  barrier();
  uint before = 0u;
  for (uint i = 0u; i < lane; ++i) before += sums[i];
  for (uint i = first; i < end; ++i) {
    const uint count = counts[i];
    counts[i] = before;
    before += count;
  }
  if (lane == 63u) counts[0] = before;
}
#else
layout(binding = UNIT_PATH_PIXELS) uniform usamplerBuffer paths;
layout(std430, binding = BINDING_PATH_SLOTS) writeonly buffer Slots { uint slots[]; };

void main() {
  const uint chunk = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint first = chunk * uint(PATH_CHUNK);
  if (first >= path_count) return;
  uint next = counts[1u + chunk];
  for (uint slot = first; slot < min(first + uint(PATH_CHUNK), path_count); ++slot)
    if (texelFetch(paths, int(slot)).x != kDeadPath) slots[next++] = slot;
}
#endif
