// What came along the rays that hits sent on: it stays with them for their own pixels, and goes into the sums of their
// cells. Fixed-point numbers of 64 bits, so that the sums do not depend on the order of threads.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"

layout(binding = UNIT_NEXT_STATES) uniform samplerBuffer next_states;         // see sample_hits.comp
layout(binding = UNIT_SAMPLE_VISIBLE) uniform usamplerBuffer visible;         // a bit a slot
layout(std430, binding = BINDING_SAMPLE_LIGHT) buffer SampleLight { vec4 light[]; };  // two a slot: known, waiting
layout(std430, binding = BINDING_CELL_SUMS) buffer CellSums { uint sums[]; };  // 8 a cell: three of 64 bits; the count
layout(std430, binding = BINDING_CELLS_TOUCHED) buffer Touched { uint groups[3]; uint touched_count; uint touched[]; };

uniform uint path_count;
uniform float greatest_light;  // of a sample, nit; what is over it is cut off

const uint kNoCell = 0xffffffffu;
const float kHighUnit = 1024.0;     // nit in the upper word's unit
const float kLowUnits = 4194304.0;  // lower words' units in a nit; kHighUnit * kLowUnits is 2^32

void add(uint word, float value) {
  const float high = floor(value / kHighUnit);
  const uint low = uint((value - high * kHighUnit) * kLowUnits);
  const uint before = atomicAdd(sums[word], low);
  const uint carried = uint(high) + (before + low < before ? 1u : 0u);
  if (carried > 0u) atomicAdd(sums[word + 1u], carried);
}

void deposit(uint cell, vec3 value) {
  if (cell == kNoCell) return;
  add(8u * cell, value.r);
  add(8u * cell + 2u, value.g);
  add(8u * cell + 4u, value.b);
  if (atomicAdd(sums[8u * cell + 6u], 1u) > 0u) return;
  const uint place = atomicAdd(touched_count, 1u);
  touched[place] = cell;
  if (place % 64u == 0u) atomicAdd(groups[0], 1u);
}

void main() {
  const uint slot = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (slot >= path_count) return;
  const bool seen = (texelFetch(visible, int(slot / 32u)).x >> (slot & 31u) & 1u) != 0u;
  const vec4 known = light[2u * slot];
  const vec3 all = known.rgb + (seen ? light[2u * slot + 1u].rgb : vec3(0.0));
  const vec3 value = mix(vec3(0.0), clamp(all, 0.0, greatest_light), equal(all, all));
  light[2u * slot] = vec4(value, known.a);
  const uvec2 cells = floatBitsToUint(texelFetch(next_states, int(2u * slot + 1u)).xy);
  deposit(cells.x, value);
  deposit(cells.y, value);
}
