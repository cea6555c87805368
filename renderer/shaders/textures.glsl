// Material textures: all images of a scene in arrays of four sizes, sRGB-coded and linear ones apart, so that any hit
// can read any texture. Wrapping and nearest filtering are done here, since one array holds textures of every sampler.
// Needs passes/bindings.glsl and shaders/scene_data.glsl.
// COLOR_CLASSES and DATA_CLASSES say, a bit each, which sizes a scene has: a software device samples all that may be
// sampled.
#ifndef COLOR_CLASSES
#define COLOR_CLASSES 15
#endif
#ifndef DATA_CLASSES
#define DATA_CLASSES 15
#endif

layout(binding = UNIT_TEXTURES_SRGB) uniform sampler2DArray srgb_textures[TEXTURE_CLASSES];
layout(binding = UNIT_TEXTURES_LINEAR) uniform sampler2DArray linear_textures[TEXTURE_CLASSES];

const float kTextureClassSize[TEXTURE_CLASSES] = float[](128.0, 512.0, 1024.0, 2048.0);

// `half_texel` is that of the coarser of the levels to be filtered: the arrays repeat, and nothing but its own edge may
// reach a lookup that is clamped.
float wrap_coordinate(float x, uint mode, float half_texel) {
  const float mirrored = 1.0 - abs(mod(x, 2.0) - 1.0);
  const float clamped = clamp(mode == 1u ? mirrored : x, half_texel, 1.0 - half_texel);
  return mode == 0u ? x : clamped;
}

struct TextureLookup {
  uint array;    // 0 to 3 sRGB, 4 to 7 linear
  vec3 position; // uv and layer
  float lod;
};

// `footprint` is the width of the area to filter, in units of each set of uv.
TextureLookup texture_lookup(TextureUse use, vec2 uv0, vec2 uv1, vec2 footprint) {
  const uint slot = use.slot;
  TextureLookup lookup;
  lookup.array = slot & 7u;
  const float size = kTextureClassSize[lookup.array & 3u];
  const mat2 uv_matrix = mat2(use.uv_transform.xy, use.uv_transform.zw);
  const bool second_set = (slot & 0x200000u) != 0u;
  vec2 uv = uv_matrix * (second_set ? uv1 : uv0) + use.uv_offset;
  const float scale = max(length(uv_matrix[0]), length(uv_matrix[1]));
  const float width = (second_set ? footprint.y : footprint.x) * scale * size;
  lookup.lod = (slot & 0x100000u) != 0u ? log2(max(width, 1e-6)) : 0.0;
  const float half_texel = min(0.5 / size * exp2(ceil(max(lookup.lod, 0.0))), 0.5);
  uv = vec2(wrap_coordinate(uv.x, (slot >> 14) & 3u, half_texel), wrap_coordinate(uv.y, (slot >> 16) & 3u, half_texel));
  const bool nearest = lookup.lod <= 0.0 ? (slot & 0x40000u) != 0u : (slot & 0x80000u) != 0u;
  if (nearest) uv = (floor(uv * size) + 0.5) / size;
  lookup.position = vec3(uv, float((slot >> 3) & 0x7ffu));
  return lookup;
}

// `texel` becomes what is sampled from one of the arrays. The first that the scene has needs no test.
#define SAMPLE_CLASS(textures, classes, size_class)                                          \
  if ((classes & (1 << size_class)) != 0 &&                                                  \
      ((classes & ((1 << size_class) - 1)) == 0 || (lookup.array & 3u) == uint(size_class))) \
    texel = textureLod(textures[size_class], lookup.position, lookup.lod);
#define SAMPLE_CLASSES(textures, classes) \
  SAMPLE_CLASS(textures, classes, 0)      \
  SAMPLE_CLASS(textures, classes, 1)      \
  SAMPLE_CLASS(textures, classes, 2)      \
  SAMPLE_CLASS(textures, classes, 3)

// Colours, decoded from sRGB before filtering.
vec4 sample_color_texture(TextureUse use, vec2 uv0, vec2 uv1, vec2 footprint) {
  const TextureLookup lookup = texture_lookup(use, uv0, uv1, footprint);
  vec4 texel = vec4(0.0);
  SAMPLE_CLASSES(srgb_textures, COLOR_CLASSES)
  return texel;
}

// Data, as it is stored.
vec4 sample_data_texture(TextureUse use, vec2 uv0, vec2 uv1, vec2 footprint) {
  const TextureLookup lookup = texture_lookup(use, uv0, uv1, footprint);
  vec4 texel = vec4(0.0);
  SAMPLE_CLASSES(linear_textures, DATA_CLASSES)
  return texel;
}
