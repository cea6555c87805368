// The scene on the device; the C++ side is renderer/passes/device_scene.h. Needs passes/bindings.glsl, packing, brdf.

struct Vertex {
  uint normal;   // octahedral, 2 x snorm16
  uint tangent;  // octahedral, 2 x snorm16; the lowest bit of y is set where the handedness is negative
  vec2 uv0;
  vec2 uv1;
  uvec2 color;   // 4 x unorm16
};

struct Instance {
  vec4 world_from_object[3];  // rows
  uint first_index;
  uint first_vertex;
  uint material;
  uint flags;
};
const uint kInstanceMirrored = 1u;  // the transform's determinant is negative

struct TextureUse {
  vec4 uv_transform;  // column-major 2x2
  vec2 uv_offset;
  uint slot;          // see texture_slot() in scene_textures.cpp; 0: none
  uint padding;
};

struct Material {
  vec4 base_color;
  vec3 emission;      // nit
  float normal_scale;
  float metallic;
  float roughness;
  float f0_dielectric;
  float specular_factor;
  uint flags;
  float alpha_cutoff;
  uvec2 padding;
  TextureUse base_color_texture;
  TextureUse metallic_roughness_texture;
  TextureUse normal_texture;
  TextureUse emissive_texture;
};
const uint kMaterialAlphaMask = 1u;
const uint kMaterialAlphaBlend = 2u;
const uint kMaterialDoubleSided = 4u;
const uint kMaterialUnlit = 8u;

layout(std430, binding = BINDING_POSITIONS) readonly buffer Positions { float positions[]; };
layout(std430, binding = BINDING_VERTICES) readonly buffer Vertices { Vertex vertices[]; };
layout(std430, binding = BINDING_INDICES) readonly buffer Indices { uint indices[]; };
layout(std430, binding = BINDING_INSTANCES) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = BINDING_MATERIALS) readonly buffer Materials { Material materials[]; };

vec3 vertex_position(uint vertex) {
  return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

vec3 vertex_normal(uint packed_normal) { return unit_from_octahedral(unpackSnorm2x16(packed_normal)); }

float vertex_handedness(uint packed_tangent) { return (packed_tangent & 0x10000u) != 0u ? -1.0 : 1.0; }

vec4 vertex_color(uvec2 color) { return vec4(unpackUnorm2x16(color.x), unpackUnorm2x16(color.y)); }

vec3 transform_point(Instance instance, vec3 p) {
  const vec4 h = vec4(p, 1.0);
  return vec3(dot(instance.world_from_object[0], h), dot(instance.world_from_object[1], h),
              dot(instance.world_from_object[2], h));
}

vec3 transform_vector(Instance instance, vec3 v) {
  return vec3(dot(instance.world_from_object[0].xyz, v), dot(instance.world_from_object[1].xyz, v),
              dot(instance.world_from_object[2].xyz, v));
}

// Normals go by the cofactor matrix, which is the inverse transpose times the determinant.
vec3 transform_normal(Instance instance, vec3 n) {
  const vec3 r0 = instance.world_from_object[0].xyz;
  const vec3 r1 = instance.world_from_object[1].xyz;
  const vec3 r2 = instance.world_from_object[2].xyz;
  const vec3 cofactor = vec3(dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n));
  return normalize((instance.flags & kInstanceMirrored) != 0u ? -cofactor : cofactor);
}
