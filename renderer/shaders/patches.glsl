// Patches of similar pixels (thesis 5.1) and which of them each pixel of the indirect map refers to (5.2); the C++ side is
// renderer/passes/patches.h. Needs bindings, packing.

// What a patch traces from: its pixels' mean, or one pixel that is like no patch around it.
struct PatchPoint {
  bool valid;           // false: nothing is seen there
  ivec2 seed;           // the pixel of the indirect map whose BRDF the patch has
  vec3 position_ws;
  vec3 normal_ws;
  float view_depth_m;
  uint material;
  float roughness;
};

const uint kNoSeed = 0xffffffffu;
const uint kNoPatch = 0xffffffffu;
const uint kUnmatchedBit = 0x40000000u;  // of a reference, until it is numbered: see share_unmatched.comp
const uint kSharedBit = 0x20000000u;     // with it: the rays are another pixel's

uint packed_seed(ivec2 seed) { return uint(seed.x | seed.y << 16); }
uvec4 packed_position(PatchPoint point) {
  return uvec4(floatBitsToUint(point.position_ws), point.valid ? packed_seed(point.seed) : kNoSeed);
}
uvec4 packed_surface(PatchPoint point) {
  return uvec4(packSnorm2x16(octahedral_from_unit(point.normal_ws)), floatBitsToUint(point.view_depth_m),
               point.material, floatBitsToUint(point.roughness));
}
PatchPoint unpack_patch_point(uvec4 position, uvec4 surface) {
  return PatchPoint(position.w != kNoSeed, ivec2(position.w & 0xffffu, position.w >> 16), uintBitsToFloat(position.xyz),
                    unit_from_octahedral(unpackSnorm2x16(surface.x)), uintBitsToFloat(surface.y), surface.z,
                    uintBitsToFloat(surface.w));
}
