// The cells that samples came to in this frame: their sums become part of their values.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/cell_value.glsl"

layout(std430, binding = BINDING_CELLS_TOUCHED) readonly buffer Touched {
  uint groups[3];
  uint touched_count;
  uint touched[];
};
layout(std430, binding = BINDING_CELL_SUMS) buffer CellSums { uint sums[]; };
layout(std430, binding = BINDING_CELL_VALUES) buffer CellValues { uvec4 values[]; };

uniform float most_samples;  // that a cell ever stands for

float sum_at(uint word) { return float(sums[word + 1u]) * 1024.0 + float(sums[word]) / 4194304.0; }

void main() {
  const uint place = gl_GlobalInvocationID.x;
  if (place >= touched_count) return;
  const uint cell = touched[place];
  const vec3 sum = vec3(sum_at(8u * cell), sum_at(8u * cell + 2u), sum_at(8u * cell + 4u));
  const float count = float(sums[8u * cell + 6u]);
  const CellValue before = unpack_cell_value(values[cell]);
  const vec3 light = (before.light * before.samples + sum) / (before.samples + count);
  values[cell] = pack_cell_value(CellValue(light, min(before.samples + count, most_samples)));
  for (uint i = 0u; i < 7u; ++i) sums[8u * cell + i] = 0u;
}
