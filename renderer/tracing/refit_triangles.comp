// Moves a hierarchy's triangles to where their vertices are now: a triangle for each invocation. `refit_words`: three
// vertices for each.
#include "tracing/refit.glsl"

layout(std430, binding = TRACE_BINDING_POSITIONS) readonly buffer Positions { uint position_words[]; };

uniform uint first_triangle;
uniform uint first_vertex;

void main() {
  const uint triangle = gl_GlobalInvocationID.x;
  if (triangle >= count) return;
  for (uint corner = 0u; corner < 3u; ++corner) {
    const uint vertex = first_vertex + refit_words[first_word + 3u * triangle + corner];
    triangle_words[3u * (first_triangle + triangle) + corner].xyz =
        uvec3(position_words[3u * vertex], position_words[3u * vertex + 1u], position_words[3u * vertex + 2u]);
  }
}
