// Frees cells that nothing came to for long, a part of the table in every frame.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/cell_value.glsl"

layout(std430, binding = BINDING_CELL_KEYS) buffer CellKeys { uint cell_keys[]; };
layout(std430, binding = BINDING_CELL_VALUES) buffer CellValues { uvec4 values[]; };

uniform uint first_cell;
uniform uint cell_count;
uniform uint patience;  // frames

void main() {
  if (gl_GlobalInvocationID.x >= cell_count) return;
  const uint cell = first_cell + gl_GlobalInvocationID.x;
  if (cell_keys[cell] == 0u || ((cache_frame - values[cell].w) & 0xffffu) < patience) return;
  cell_keys[cell] = 0u;
  values[cell] = uvec4(0u);
}
