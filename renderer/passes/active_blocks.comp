// Which blocks of the indirect map see a surface at all: the others get no slots, so no directions, rays or sums.
layout(local_size_x = 16, local_size_y = 16) in;

#include "passes/bindings.glsl"
#include "shaders/sampling.glsl"
#include "shaders/indirect_map.glsl"

layout(binding = UNIT_G_DEPTH) uniform sampler2D g_depth;  // 0: nothing there
layout(std430, binding = BINDING_OUTPUT) writeonly buffer Seen { uint seen[]; };  // one a block

shared uint any_seen;

void main() {
  if (gl_LocalInvocationIndex == 0u) any_seen = 0u;
  barrier();
  const ivec2 map_pixel = ivec2(gl_GlobalInvocationID.xy);
  const bool inside = all(lessThan(map_pixel, indirect_size_px));
  if (inside && texelFetch(g_depth, representative_pixel(map_pixel), 0).r > 0.0) atomicOr(any_seen, 1u);
  barrier();
  if (gl_LocalInvocationIndex == 0u) seen[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = any_seen;
}
