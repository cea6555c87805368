// Light that arrives at surfaces after bouncing, kept in cells of the world: the C++ side is
// renderer/passes/radiance_cache.h. A cell is a cube of space and a range of normals; its side grows with the distance
// from the eye. Cells live in a hash table of buckets, four keys a texel. Needs bindings, sampling, camera.

layout(binding = UNIT_CELL_KEYS) uniform usamplerBuffer cell_key_texels;
layout(binding = UNIT_CELL_VALUES) uniform usamplerBuffer cell_value_texels;

uniform float finest_cell_m;
uniform float least_usual_m;  // near the eye cells are not smaller: too few rays come to them
uniform float cell_angle;     // a cell's side over its distance from the eye
uniform uint cell_buckets;    // a power of two

#include "shaders/cell_value.glsl"

const uint kProbedBuckets = 4u;
const float kFinestRatio = 0.125;  // the finest cell at a place over the usual one
const float kCoarseRatio = 4.0;    // a coarse cell, which helps out where the fine one is new, over the usual one
const float kFewSamples = 4.0;     // fewer say too little

struct CellPlace {
  uint bucket;
  uint key;  // never 0
};

// Of the cell around a point. `most_side_m`: what lights the point from nearer than this must not share a cell with it.
// `u` moves the point within its surface by up to a quarter of a cell, so that edges of cells do not show.
CellPlace cell_place(vec3 position_ws, vec3 normal_ws, float most_side_m, bool coarse, vec2 u) {
  const float usual_m = max(distance(position_ws, camera.eye_ws.xyz) * cell_angle, least_usual_m);
  const float wanted_m = coarse ? usual_m * kCoarseRatio : clamp(most_side_m, usual_m * kFinestRatio, usual_m);
  const int level = int(floor(log2(wanted_m / finest_cell_m)));
  const float side_m = finest_cell_m * exp2(float(level));
  const mat3 frame = frame_around(normal_ws);
  const vec2 by_m = 0.5 * side_m * (u - 0.5);
  const vec3 moved = position_ws + by_m.x * frame[0] + by_m.y * frame[1];
  // Off the round numbers, where walls like to stand.
  const ivec3 cube = ivec3(floor(moved / side_m + vec3(0.137, 0.291, 0.413)));
  const ivec3 facing = ivec3(round(normal_ws)) + 1;
  const uint rest = uint(level + 64) << 8 | uint(facing.x << 4 | facing.y << 2 | facing.z);
  const uint first = hash(uvec3(cube) + rest * 0x9e3779b9u);
  return CellPlace(first & (cell_buckets - 1u), hash(uvec3(cube.zxy) ^ (rest * 0x85ebca6bu)) | 1u);
}

// kNoCell if there is none.
uint find_cell(CellPlace place) {
  uint found = kNoCell;
  // By a bound that no compiler knows, so that it stays a loop: a software device goes through one only as long as a lane
  // has something to find, but through all that a branch leaves out.
  const uint probes = min(kProbedBuckets, cell_buckets);
  for (uint probe = 0u; probe < probes && found == kNoCell; ++probe) {
    const uint bucket = (place.bucket + probe) & (cell_buckets - 1u);
    const uvec4 keys = texelFetch(cell_key_texels, int(bucket));
    if (keys.x == place.key) found = 4u * bucket;
    if (keys.y == place.key) found = 4u * bucket + 1u;
    if (keys.z == place.key) found = 4u * bucket + 2u;
    if (keys.w == place.key) found = 4u * bucket + 3u;
  }
  return found;
}

// What a cell knows; no samples if there is none.
CellValue value_of(uint cell) {
  if (cell == kNoCell) return CellValue(vec3(0.0), 0.0);
  return unpack_cell_value(texelFetch(cell_value_texels, int(cell)));
}

#ifdef CELL_INSERTION
layout(std430, binding = BINDING_CELL_KEYS) buffer CellKeys { uint cell_keys[]; };

// A cell that find_cell() has not found, made where one is `wanted`; kNoCell if its buckets are full. Places become empty
// between frames alone, so that all who look for a key try the same empty places in the same order and agree.
uint make_cell(CellPlace place, bool wanted) {
  uint cell = kNoCell;
  const uint places = wanted ? 4u * kProbedBuckets : 0u;
  for (uint probe = 0u; probe < places && cell == kNoCell; ++probe) {
    const uint index = (4u * place.bucket + probe) & (4u * cell_buckets - 1u);
    const uint there = atomicCompSwap(cell_keys[index], 0u, place.key);
    if (there == 0u || there == place.key) cell = index;
  }
  return cell;
}
#endif
