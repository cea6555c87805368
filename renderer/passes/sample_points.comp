// The random numbers of a batch of directions: a Sobol point in the unit square and a number to choose a lobe by, for each
// of the 16 places in a tile (shaders/indirect_map.glsl). One table for all tiles.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/sampling.glsl"

layout(std430, binding = BINDING_OUTPUT) writeonly buffer Points { vec4 points[]; };

uniform uint first_direction;
uniform uint direction_count;
uniform uint seed;

void main() {
  const uint index = gl_GlobalInvocationID.x;
  if (index >= 16u * direction_count) return;
  const uint number = first_direction + index / 16u;
  const uint place_seed = hash(uvec3(index % 16u, 0u, seed));
  points[index] = vec4(sobol_2d(number, place_seed), sobol_1d(number, place_seed ^ 0x9e3779b9u), 0.0);
}
