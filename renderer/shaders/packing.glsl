// Unit vectors as two signed-normalised numbers: the octahedral map of Cigolle et al. 2014, "A survey of efficient
// representations for independent unit vectors". LANES: see shaders/select.glsl.
#include "shaders/select.glsl"

#ifndef LANES
vec2 octahedral_from_unit(vec3 unit) {
  const vec2 projected = unit.xy / (abs(unit.x) + abs(unit.y) + abs(unit.z));
  const vec2 signs = vec2(projected.x >= 0.0 ? 1.0 : -1.0, projected.y >= 0.0 ? 1.0 : -1.0);
  return unit.z >= 0.0 ? projected : (1.0 - abs(projected.yx)) * signs;
}

#endif

vec3 unit_from_octahedral(vec2 octahedral) {
  vec3 unit = vec3(octahedral, 1.0 - abs(octahedral.x) - abs(octahedral.y));
  const float fold = max(-unit.z, 0.0);
  unit.x += select(unit.x >= 0.0, -fold, fold);
  unit.y += select(unit.y >= 0.0, -fold, fold);
  return normalize(unit);
}

#ifndef LANES
float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }  // BT.709

// The G-buffer's packed words; shaders/g_buffer.glsl reads them.
uvec4 pack_g_surface(vec3 normal_ws, vec3 geometric_normal_ws, vec3 base_color, float metallic) {
  return uvec4(packSnorm2x16(octahedral_from_unit(normal_ws)), packSnorm2x16(octahedral_from_unit(geometric_normal_ws)),
               packUnorm2x16(base_color.rg), packUnorm2x16(vec2(base_color.b, metallic)));
}

// A unit vector in 24 bits and a number of [0, 1] in 8.
uint pack_normal_roughness(vec3 normal, float roughness) {
  const uvec2 octahedral = uvec2(clamp(octahedral_from_unit(normal) * 0.5 + 0.5, 0.0, 1.0) * 4095.0 + 0.5);
  return octahedral.x | octahedral.y << 12 | uint(roughness * 255.0 + 0.5) << 24;
}

vec4 unpack_normal_roughness(uint bits) {
  const vec2 octahedral = vec2(float(bits & 0xfffu), float((bits >> 12) & 0xfffu)) / 4095.0 * 2.0 - 1.0;
  return vec4(unit_from_octahedral(octahedral), float(bits >> 24) / 255.0);
}
#endif
