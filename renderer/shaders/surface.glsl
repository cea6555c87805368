// A shaded point: material, textures and vertex attributes come together. Needs scene_data, brdf, packing and textures.
// HAS_TEXTURES: base colours may be textured and vertices coloured; ALL_TEXTURES: the other textures may be there too.

#include "shaders/shading_normal.glsl"

struct Attributes {
  vec3 normal_ws;       // unit, interpolated
  vec3 tangent_ws;      // not normalised
  float handedness;
  vec2 uv0;
  vec2 uv1;
  vec4 color;
};

struct Surface {
  vec4 base_color;      // with coverage in a
  float metallic;
  float roughness;
  vec3 emission;        // nit
  vec3 normal_ws;       // unit, normal map applied, not yet turned towards the viewer
};

#ifdef ALL_TEXTURES
// The interpolated normal, or what a normal map makes of it.
vec3 mapped_normal(TextureUse use, float scale, Attributes at, vec2 footprint) {
  const vec3 tangent = at.tangent_ws - at.normal_ws * dot(at.normal_ws, at.tangent_ws);
  if (use.slot == 0u || dot(tangent, tangent) <= 1e-12) return at.normal_ws;
  const vec3 texel = sample_data_texture(use, at.uv0, at.uv1, footprint).xyz * 2.0 - 1.0;
  const vec3 t = normalize(tangent);
  const vec3 b = at.handedness * cross(at.normal_ws, t);
  return normalize((t * texel.x + b * texel.y) * scale + at.normal_ws * texel.z);
}
#endif

// `footprint` in units of each set of uv: how wide an area the lookups should average.
Surface shade_surface(Material material, Attributes at, vec2 footprint) {
  Surface surface;
  surface.base_color = material.base_color * at.color;
  surface.metallic = material.metallic;
  surface.roughness = material.roughness;
  surface.emission = material.emission;
  surface.normal_ws = at.normal_ws;
#ifdef HAS_TEXTURES
  if (material.base_color_texture.slot != 0u)
    surface.base_color *= sample_color_texture(material.base_color_texture, at.uv0, at.uv1, footprint);
#endif
#ifdef ALL_TEXTURES
  if (material.metallic_roughness_texture.slot != 0u) {
    const vec4 texel = sample_data_texture(material.metallic_roughness_texture, at.uv0, at.uv1, footprint);
    surface.roughness *= texel.g;
    surface.metallic *= texel.b;
  }
  if (material.emissive_texture.slot != 0u)
    surface.emission *= sample_color_texture(material.emissive_texture, at.uv0, at.uv1, footprint).rgb;
  surface.normal_ws = mapped_normal(material.normal_texture, material.normal_scale, at, footprint);
#endif
  return surface;
}
