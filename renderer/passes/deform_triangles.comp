// What hits need to know of deformed triangles, after deform_vertices.comp: one for each invocation.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "passes/deform_task.glsl"

layout(std430, binding = BINDING_DEFORM_TRIANGLES) writeonly buffer Triangles { uvec4 triangle_texels[]; };

layout(binding = UNIT_POSITIONS) uniform samplerBuffer positions;
layout(binding = UNIT_VERTICES) uniform usamplerBuffer vertex_words;    // 2 texels a vertex
layout(binding = UNIT_TRIANGLES) uniform usamplerBuffer triangle_words;  // DeviceTriangle: 2 texels

void main() {
  const Task task = own_task();
  const uint triangle = own_number(task);
  if (triangle >= task.count) return;
  const uvec3 corners = texelFetch(triangle_words, int(2u * (task.first_source + triangle) + 1u)).xyz;
  const ivec3 vertices = ivec3(corners + task.target_vertex);
  const uvec4 a = texelFetch(vertex_words, 2 * vertices.x), b = texelFetch(vertex_words, 2 * vertices.y);
  const uvec4 c = texelFetch(vertex_words, 2 * vertices.z);
  const vec3 corner = texelFetch(positions, vertices.x).xyz;
  const vec3 area_normal =
      cross(texelFetch(positions, vertices.y).xyz - corner, texelFetch(positions, vertices.z).xyz - corner);
  const float area = length(area_normal);
  const uint normal = area > 0.0 ? packSnorm2x16(octahedral_from_unit(area_normal / area)) : a.x;
  const vec2 uv = uintBitsToFloat(a.zw);
  const vec2 u = uintBitsToFloat(b.zw) - uv, v = uintBitsToFloat(c.zw) - uv;
  const float uv_per_m = area > 0.0 ? sqrt(abs(u.x * v.y - u.y * v.x) / area) : 0.0;
  const uint target = task.first_target + triangle;
  triangle_texels[2u * target] = uvec4(a.x, b.x, c.x, normal);
  triangle_texels[2u * target + 1u] = uvec4(corners, floatBitsToUint(uv_per_m));
}
