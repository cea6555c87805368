// The state of paths in flight: renderer/passes/path_tracer.h. A path lives in a slot; after every bounce those that met a
// surface take the first slots, so that all lanes have work. Needs packing, sampling.

// A path's word: which pixel of the wave it belongs to, how many surfaces it has met, through how many clear walls it has
// come since (the last three bits of it), and whether the light that waits for its shadow ray is direct.
const uint kPixelBits = 19u, kDepthBits = 9u, kWallBits = 3u;
const uint kDirectLight = 1u << 31u;
uint pack_path(uint pixel, uint depth, uint walls) {
  return pixel | depth << kPixelBits | (walls & ((1u << kWallBits) - 1u)) << (kPixelBits + kDepthBits);
}
uint path_pixel(uint path) { return path & ((1u << kPixelBits) - 1u); }
uint path_depth(uint path) { return path >> kPixelBits & ((1u << kDepthBits) - 1u); }
uint path_walls(uint path) { return path >> (kPixelBits + kDepthBits) & ((1u << kWallBits) - 1u); }
// Without a limit paths end here: Russian roulette lets fewer than one in 10^4 come so far even between white walls.
const uint kGreatestDepth = (1u << kDepthBits) - 1u;

uniform vec2 shown;  // of direct and of indirect light, 0 or 1

// Its part of a pixel: the light the view shows and the luminance of all.
vec4 shown_light(vec3 light, bool direct) { return vec4(light * (direct ? shown.x : shown.y), luminance(light)); }

// What the camera sees that is no lit surface, straight or through clear walls: `mark` tells what it is, see Picture.
vec4 unlit_light(vec3 light, vec3 throughput, float mark, vec4 before) {
  return before.a == 0.0 ? vec4(light * shown.x, mark) : shown_light(throughput * light, true);
}

// The first of the picture's pixels in this wave, in rows; the picture's width.
uniform uint first_pixel;
uniform int picture_width_px;

ivec2 picture_pixel(uint wave_pixel) {
  const uint index = first_pixel + wave_pixel;
  return ivec2(index % uint(picture_width_px), index / uint(picture_width_px));
}

// Sobol points: every pixel has sequences of its own, one for each decision along its paths; the sample is the index.
uniform uint sample_number;
uniform uint seed;

uint pixel_seed(ivec2 pixel) { return hash(uvec3(pixel, seed)); }

const uint kDecisionFilter = 0u;
const uint kDecisionLight = 1u, kDecisionDirection = 2u, kDecisionKinds = 3u, kDecisionSurvival = 4u;
uint decision_seed(uint pixel_seed, uint depth, uint decision) {
  return pixel_seed + (4u * depth + decision) * 0x9e3779b9u;
}
