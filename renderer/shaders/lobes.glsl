// What glTF's material extensions add to a surface, and their lobes to its BRDF: the variant HAS_LOBES of a shader.
// Needs brdf and packing; with ALL_TEXTURES, for surfaces that are not in the G-buffer, scene_data, textures and surface.

struct Lobes {
  vec3 f0_dielectric;         // with the specular colour, before the specular factor
  float specular_factor;
  float transmission;
  float ior;                  // of the volume behind the surface; 0: thin-walled
  vec3 absorption;            // of the volume, 1 / m
  float clearcoat;
  float clearcoat_roughness;
  vec3 clearcoat_normal_ws;   // unit, on the side of the surface's normal
  vec3 sheen_color;
  float sheen_roughness;
};

#ifdef ALL_TEXTURES
vec4 lobe_texel(int texel, Attributes at, vec2 footprint) {
  const TextureUse use = fetch_texture_use(texel);
  return use.slot != 0u ? sample_data_texture(use, at.uv0, at.uv1, footprint) : vec4(1.0);
}

vec3 lobe_color(int texel, Attributes at, vec2 footprint) {
  const TextureUse use = fetch_texture_use(texel);
  return use.slot != 0u ? sample_color_texture(use, at.uv0, at.uv1, footprint).rgb : vec3(1.0);
}

Lobes shade_lobes(uint material, Material plain, Attributes at, vec2 footprint) {
  const int first = int(kMaterialTexels * material) + 12;
  const vec4 base = uintBitsToFloat(texelFetch(material_words, first));
  const vec4 sheen = uintBitsToFloat(texelFetch(material_words, first + 1));
  const vec4 clearcoat = uintBitsToFloat(texelFetch(material_words, first + 2));
  Lobes lobes;
  lobes.specular_factor = plain.specular_factor * lobe_texel(first + 4, at, footprint).a;
  lobes.f0_dielectric = min(base.rgb * lobe_color(first + 6, at, footprint), vec3(1.0));
  lobes.transmission = base.w * lobe_texel(first + 8, at, footprint).r;
  lobes.ior = clearcoat.w;
  lobes.absorption = uintBitsToFloat(texelFetch(material_words, first + 3)).rgb;
  lobes.clearcoat = clearcoat.x * lobe_texel(first + 10, at, footprint).r;
  lobes.clearcoat_roughness = clearcoat.y * lobe_texel(first + 12, at, footprint).g;
  const TextureUse normal_texture = fetch_texture_use(first + 14);
  lobes.clearcoat_normal_ws = mapped_normal(normal_texture, clearcoat.z, at, footprint);
  lobes.sheen_color = sheen.rgb * lobe_color(first + 16, at, footprint);
  lobes.sheen_roughness = sheen.w * lobe_texel(first + 18, at, footprint).a;
  return lobes;
}

#endif

// The BRDF with its lobes; `eta` is the refractive index beyond the surface over that on the viewer's side, 1 for thin walls.
Brdf with_lobes(Brdf plain, vec3 base_color, float metallic, Lobes lobes, float eta) {
  Brdf brdf = make_brdf(base_color, metallic, sqrt(plain.alpha), lobes.f0_dielectric, lobes.specular_factor);
  brdf.demodulation_f0 = plain.f0;
  brdf.transmission_color = brdf.diffuse_albedo * lobes.transmission;
  brdf.diffuse_albedo *= 1.0 - lobes.transmission;
  brdf.eta = eta;
  brdf.clearcoat = lobes.clearcoat;
  brdf.clearcoat_alpha = alpha_from_roughness(lobes.clearcoat_roughness);
  brdf.clearcoat_normal = lobes.clearcoat_normal_ws;
  brdf.sheen_color = lobes.sheen_color;
  brdf.sheen_roughness = lobes.sheen_roughness;
  return brdf;
}

// In the last word of the lobes: what passes the surface is shown by another layer of the G-buffer.
const uint kNothingPasses = 0x80000000u;

// The G-buffer's words of the lobes; the dielectric's greatest f0 and its specular factor are elsewhere in it.
uvec4 pack_g_lobes(Lobes lobes, bool behind) {
  const vec3 f0 = lobes.f0_dielectric;
  const vec3 hue = f0 / max(max(f0.r, max(f0.g, f0.b)), 1e-6);
  const float eta = lobes.ior > 0.0 ? (behind ? 1.0 / lobes.ior : lobes.ior) : 1.0;
  const uint clearcoat = packUnorm4x8(vec4(lobes.clearcoat, lobes.clearcoat_roughness, 0.0, 0.0)) & 0xffffu;
  return uvec4(packUnorm4x8(vec4(hue, lobes.transmission)),
               packUnorm4x8(vec4(lobes.sheen_color, lobes.sheen_roughness)),
               packSnorm2x16(octahedral_from_unit(lobes.clearcoat_normal_ws)),
               clearcoat | packHalf2x16(vec2(0.0, eta)) & 0xffff0000u);
}

Lobes unpack_g_lobes(uvec4 words, vec2 f0_specular) {
  const vec4 base = unpackUnorm4x8(words.x), sheen = unpackUnorm4x8(words.y), clearcoat = unpackUnorm4x8(words.w);
  Lobes lobes;
  lobes.f0_dielectric = f0_specular.x * base.rgb;
  lobes.specular_factor = f0_specular.y;
  lobes.transmission = base.w;
  lobes.ior = 0.0;
  lobes.absorption = vec3(0.0);
  lobes.clearcoat = clearcoat.x;
  lobes.clearcoat_roughness = clearcoat.y;
  lobes.clearcoat_normal_ws = unit_from_octahedral(unpackSnorm2x16(words.z));
  lobes.sheen_color = sheen.rgb;
  lobes.sheen_roughness = sheen.w;
  return lobes;
}

float g_lobes_eta(uvec4 words) { return unpackHalf2x16(words.w & ~kNothingPasses).y; }
