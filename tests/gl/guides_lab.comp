// The guides of a point at the origin that faces +Z, in a cell of 1 m, for guides_test.cpp. A query is a direction, or
// random numbers for one.
layout(local_size_x = 64) in;
#include "passes/bindings.glsl"
#include "shaders/sampling.glsl"
#include "shaders/guide_cells.glsl"
#include "shaders/guides.glsl"
layout(std430, binding = 0) readonly buffer Queries { vec4 queries[]; };
layout(std430, binding = 1) writeonly buffer Results { vec4 results[]; };
uniform uint count;
uniform int sampled;
void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= count) return;
  const Guides guides = guides_at(vec3(0.0), vec3(0.0, 0.0, 1.0));
  const vec3 query = queries[index].xyz;
  const vec3 direction = sampled == 1 ? sample_guides(guides, query.xy, query.z) : query;
  results[index] = vec4(direction, guides_pdf(guides, direction));
}
