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
  uint first_vertex;
  uint first_triangle;  // of triangle_words
  uint material;
  uint flags;
};
const uint kInstanceMirrored = 1u;  // the transform's determinant is negative

struct TextureUse {
  vec4 uv_transform;  // column-major 2x2
  vec2 uv_offset;
  uint slot;          // see SceneTextures::slot(); 0: none
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
#ifdef HAS_TEXTURES
  TextureUse base_color_texture;
  TextureUse metallic_roughness_texture;
  TextureUse normal_texture;
  TextureUse emissive_texture;
#endif
};
const uint kMaterialAlphaMask = 1u;
const uint kMaterialAlphaBlend = 2u;
const uint kMaterialDoubleSided = 4u;
const uint kMaterialUnlit = 8u;
const uint kMaterialClear = 16u;      // light goes straight on through it, see shaders/clear_surface.glsl
const uint kMaterialClearWall = 32u;  // and without a volume behind it

// Blended surfaces with a greater alpha throw shadows as opaque ones do, the others let light through.
const float kOpaqueAlpha = 0.99;

// Buffer textures of 128-bit texels: a hit's data is scattered, and a software device fetches a texel of four words as
// fast as a single word of a storage buffer.
layout(binding = UNIT_VERTICES) uniform usamplerBuffer vertex_words;      // 2 texels a vertex
layout(binding = UNIT_TRIANGLES) uniform usamplerBuffer triangle_words;   // 2 texels a triangle
layout(binding = UNIT_INSTANCES) uniform usamplerBuffer instance_words;   // 4 texels an instance
layout(binding = UNIT_MATERIALS) uniform usamplerBuffer material_words;   // 32 texels a material

Vertex fetch_vertex(uint vertex) {
  const uvec4 a = texelFetch(vertex_words, int(2u * vertex));
  const uvec4 b = texelFetch(vertex_words, int(2u * vertex + 1u));
  return Vertex(a.x, a.y, uintBitsToFloat(a.zw), uintBitsToFloat(b.xy), b.zw);
}

// Object space, octahedral: the normals of the three corners and, in w, the geometric one by the winding.
uvec4 triangle_normals(Instance instance, uint triangle) {
  return texelFetch(triangle_words, int(2u * (instance.first_triangle + triangle)));
}

// The vertices of the three corners and, in w as bits, the width of 1 m in units of the first uv set.
uvec4 triangle_corners(Instance instance, uint triangle) {
  const uvec4 words = texelFetch(triangle_words, int(2u * (instance.first_triangle + triangle) + 1u));
  return uvec4(words.xyz + instance.first_vertex, words.w);
}

Instance fetch_instance(uint index) {
  const int first = int(4u * index);
  const uvec4 rest = texelFetch(instance_words, first + 3);
  return Instance(vec4[3](uintBitsToFloat(texelFetch(instance_words, first)),
                          uintBitsToFloat(texelFetch(instance_words, first + 1)),
                          uintBitsToFloat(texelFetch(instance_words, first + 2))),
                  rest.x, rest.y, rest.z, rest.w);
}

TextureUse fetch_texture_use(int texel) {
  const vec4 uv_transform = uintBitsToFloat(texelFetch(material_words, texel));
  const uvec4 rest = texelFetch(material_words, texel + 1);
  return TextureUse(uv_transform, uintBitsToFloat(rest.xy), rest.z);
}

const uint kMaterialTexels = 32u;

Material fetch_material(uint index) {
  const int first = int(kMaterialTexels * index);
  const uvec4 emission = texelFetch(material_words, first + 1);
  const vec4 lobes = uintBitsToFloat(texelFetch(material_words, first + 2));
  const uvec4 rest = texelFetch(material_words, first + 3);
  Material material;
  material.base_color = uintBitsToFloat(texelFetch(material_words, first));
  material.emission = uintBitsToFloat(emission.xyz);
  material.normal_scale = uintBitsToFloat(emission.w);
  material.metallic = lobes.x;
  material.roughness = lobes.y;
  material.f0_dielectric = lobes.z;
  material.specular_factor = lobes.w;
  material.flags = rest.x;
  material.alpha_cutoff = uintBitsToFloat(rest.y);
#ifdef HAS_TEXTURES
  material.base_color_texture = fetch_texture_use(first + 4);
  material.metallic_roughness_texture = fetch_texture_use(first + 6);
  material.normal_texture = fetch_texture_use(first + 8);
  material.emissive_texture = fetch_texture_use(first + 10);
#endif
  return material;
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
