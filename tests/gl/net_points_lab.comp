// Points of shaders/net_points.glsl: of each texel of a square, `numbers` of them from `first_number` on.
layout(local_size_x = 64) in;

#include "shaders/sampling.glsl"
#include "shaders/net_points.glsl"

layout(std430, binding = 0) writeonly buffer Points { vec2 points[]; };

uniform uint side;  // texels
uniform uint numbers;
uniform uint first_number;
uniform uint decision;
uniform uint seed;

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= side * side * numbers) return;
  const uint texel = index / numbers;
  points[index] = net_2d(net_place(uvec2(texel % side, texel / side), seed), first_number + index % numbers, decision);
}
