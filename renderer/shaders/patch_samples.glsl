// The indirect map of `realtime`: a texel stands for a patch of the picture, and in every frame another real pixel of the
// patch stands for the texel. Where patches of texels share a frame's rays, one texel of each has them in turn. Ray j of
// traced texel i lies in slot j * traced_texels() + i. Needs sampling, camera.
// PIXEL_LIST: a row of pixels in place of the map.
#include "shaders/net_points.glsl"

uniform ivec2 map_size_px;
uniform vec2 pixels_per_texel;
uniform uint rays_per_texel;
uniform uint frame_number;
uniform uint seed;
uniform ivec2 patches;       // of texels, across and up
uniform ivec2 log2_patch;    // texels of a patch
uniform ivec2 traced_place;  // in the patch, of the texel that has rays

uint traced_texels() { return uint(patches.x * patches.y); }

// In patches of two, every other row is a turn ahead.
ivec2 traced_texel(uint index) {
  const ivec2 corner = ivec2(index % uint(patches.x), index / uint(patches.x));
  const ivec2 side = ivec2(1) << log2_patch;
  const int ahead = corner.y * (1 - log2_patch.y);
  return min(corner * side + ivec2((traced_place.x + ahead) & (side.x - 1), traced_place.y), map_size_px - 1);
}

// Of the patch that the texel is in.
uint traced_index(ivec2 texel) {
  const ivec2 corner = texel >> log2_patch;
  return uint(corner.y * patches.x + corner.x);
}

// How often a texel has had rays: its sequences go on by one each time.
uint own_frame() { return frame_number >> uint(log2_patch.x + log2_patch.y); }

#ifdef PIXEL_LIST
layout(binding = UNIT_PIXEL_LIST) uniform usamplerBuffer pixel_list;  // y << 16 | x

ivec2 sampled_pixel(ivec2 texel) {
  const uint word = texelFetch(pixel_list, texel.x).x;
  return ivec2(word & 0xffffu, word >> 16);
}

// Not by the place in the list, for that is another in every run.
NetPlace place_of_texel(ivec2 texel) { return net_place(uvec2(sampled_pixel(texel)), hash(seed ^ 0x3c6ef372u)); }
#else
NetPlace place_of_texel(ivec2 texel) { return net_place(uvec2(texel), seed); }

// The points of a frame lie as the R2 sequence (Roberts 2018), from a start of each texel's own.
ivec2 sampled_pixel(ivec2 texel) {
  const uint bits = hash(hash(uvec3(texel, seed)) ^ 0x2545f491u);
  const uvec2 point = uvec2(bits, hash(bits)) + own_frame() * uvec2(0xc13fa9aau, 0x91e10da6u);
  const vec2 within = vec2(unit_interval(point.x), unit_interval(point.y));
  return min(ivec2((vec2(texel) + within) * pixels_per_texel), camera.size_px.xy - 1);
}
#endif

#ifdef REFRACTED
uint sample_number(uint ray) { return frame_number; }  // a pixel's rays are of different light
#else
uint sample_number(uint ray) { return own_frame() * rays_per_texel + ray; }
#endif

// Every decision of a texel's paths has a sequence of its own.
const uint kDecisionRay = 1u, kDecisionLobe = 2u, kDecisionLamp = 3u, kDecisionLampChoice = 4u;
const uint kDecisionLight = 5u, kDecisionLightChoice = 6u, kDecisionNextRay = 7u, kDecisionCell = 8u;  // at a hit
const uint kDecisionRefraction = 9u;
