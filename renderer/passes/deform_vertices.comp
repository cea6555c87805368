// Morph targets, then skins, as glTF 2.0 has them (3.7.2.2, 3.7.3.3): a vertex for each invocation. The processor's own
// way is renderer/scene/deform.cpp.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "passes/deform_task.glsl"

const uint kNone = 0xffffffffu;

// A morph target that has a weight; where its displacements begin, or kNone.
struct Morph {
  uint first_position, first_normal, first_tangent;
  float weight;
};

layout(std430, binding = BINDING_DEFORM_MORPHS) readonly buffer Morphs { Morph morphs[]; };
layout(std430, binding = BINDING_DEFORM_POSITIONS) writeonly buffer Positions { float position_words[]; };
layout(std430, binding = BINDING_DEFORM_VERTICES) writeonly buffer Vertices { uvec4 vertex_texels[]; };  // 2 a vertex

layout(binding = UNIT_POSITIONS) uniform samplerBuffer positions;
layout(binding = UNIT_VERTICES) uniform usamplerBuffer vertex_words;
layout(binding = UNIT_INFLUENCES) uniform usamplerBuffer influences;         // DeviceInfluence: 2 texels
layout(binding = UNIT_DISPLACEMENTS) uniform samplerBuffer displacements;
layout(binding = UNIT_JOINT_MATRICES) uniform samplerBuffer matrix_rows;    // 3 a joint

struct Shape {
  vec3 position, normal, tangent;
  float side;  // -1: a mirror has turned the handedness over
};

// `v` at unit length, or `fallback` where it has none.
vec3 unit_or(vec3 v, vec3 fallback) {
  const float squared = dot(v, v);
  return squared > 0.0 && !isinf(squared) ? v * inversesqrt(squared) : fallback;
}

vec3 displacement(uint first, uint vertex) {
  return first == kNone ? vec3(0.0) : texelFetch(displacements, int(first + vertex)).xyz;
}

void morph(Task task, uint vertex, inout Shape shape) {
  vec3 normal = shape.normal, tangent = shape.tangent;
  for (uint i = task.first_morph; i < task.first_morph + task.morphs; ++i) {
    const Morph target = morphs[i];
    shape.position += target.weight * displacement(target.first_position, vertex);
    normal += target.weight * displacement(target.first_normal, vertex);
    tangent += target.weight * displacement(target.first_tangent, vertex);
  }
  shape.normal = unit_or(normal, shape.normal);
  shape.tangent = unit_or(tangent, shape.tangent);
}

// Normals go by the cofactors, which are the inverse transpose times the determinant: safe for a collapsed scale.
void skin(Task task, uint vertex, inout Shape shape) {
  const int first = int(2u * (task.first_influence + vertex));
  const uvec4 joints = min(texelFetch(influences, first), uvec4(task.last_joint));
  const vec4 weights = uintBitsToFloat(texelFetch(influences, first + 1));
  if (weights == vec4(0.0)) return;
  vec4 rows[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
  for (int k = 0; k < 4; ++k) {
    const int matrix = int(3u * (task.first_matrix + joints[k]));
    for (int row = 0; row < 3; ++row) rows[row] += weights[k] * texelFetch(matrix_rows, matrix + row);
  }
  const vec3 x = rows[0].xyz, y = rows[1].xyz, z = rows[2].xyz;
  const vec4 p = vec4(shape.position, 1.0);
  shape.position = vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
  const vec3 cofactor_x = cross(y, z);
  shape.side = dot(x, cofactor_x) < 0.0 ? -1.0 : 1.0;
  const vec3 n = shape.normal, t = shape.tangent;
  shape.normal = unit_or(shape.side * vec3(dot(cofactor_x, n), dot(cross(z, x), n), dot(cross(x, y), n)), n);
  shape.tangent = unit_or(vec3(dot(x, t), dot(y, t), dot(z, t)), t);
}

void main() {
  const Task task = own_task();
  const uint vertex = own_number(task);
  if (vertex >= task.count) return;
  const int source = int(task.first_source + vertex);
  const uvec4 first_words = texelFetch(vertex_words, 2 * source);
  Shape shape = Shape(texelFetch(positions, source).xyz, unit_from_octahedral(unpackSnorm2x16(first_words.x)),
                      unit_from_octahedral(unpackSnorm2x16(first_words.y)), 1.0);
  if (task.morphs > 0u) morph(task, vertex, shape);
  if (task.first_influence != kNone) skin(task, vertex, shape);

  const uint target = task.first_target + vertex;
  for (int axis = 0; axis < 3; ++axis) position_words[3u * target + uint(axis)] = shape.position[axis];
  const uint mirrored = (first_words.y & 0x10000u) ^ (shape.side < 0.0 ? 0x10000u : 0u);
  const uint tangent = (packSnorm2x16(octahedral_from_unit(shape.tangent)) & ~0x10000u) | mirrored;
  vertex_texels[2u * target] = uvec4(packSnorm2x16(octahedral_from_unit(shape.normal)), tangent, first_words.zw);
  vertex_texels[2u * target + 1u] = texelFetch(vertex_words, 2 * source + 1);
}
