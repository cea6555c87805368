// What arrives along a ray, in four words, so that rays that miss cost no more than they must. Needs packing.
// Until the ray is lit, and for good if it hits nothing: its weight f cos(theta) / pdf and its direction. If it hits:
// the light of the hit times the weight, and the distance.

const uint kUnlitBit = 0x80000000u;  // in w; a distance has no sign

uvec4 pack_unlit(vec3 weight, vec3 direction_ws) {
  const uvec2 octahedral =
      uvec2(clamp(octahedral_from_unit(direction_ws) * 0.5 + 0.5, 0.0, 1.0) * vec2(65535.0, 32767.0) + 0.5);
  return uvec4(floatBitsToUint(weight), octahedral.x | octahedral.y << 16 | kUnlitBit);
}

uvec4 pack_lit(vec3 weighted_radiance, float distance_m) {
  return uvec4(floatBitsToUint(weighted_radiance), floatBitsToUint(distance_m));
}

bool is_lit(uvec4 arriving) { return (arriving.w & kUnlitBit) == 0u; }

// The weight of an unlit ray, the weighted radiance of a lit one.
vec3 color_of(uvec4 arriving) { return uintBitsToFloat(arriving.rgb); }

vec3 direction_of_unlit(uvec4 arriving) {
  const vec2 octahedral = vec2(arriving.w & 0xffffu, arriving.w >> 16 & 0x7fffu) / vec2(65535.0, 32767.0);
  return unit_from_octahedral(octahedral * 2.0 - 1.0);
}

float distance_of_lit(uvec4 arriving) { return uintBitsToFloat(arriving.w); }
