// Random numbers and directions. All are functions of (pixel, sample, seed): the same request gives the same bytes.

#include "shaders/frame.glsl"

// A good 32-bit mixer: Wellons 2018, "lowbias32".
uint hash(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

uint hash(uvec3 v) { return hash(v.x + hash(v.y + hash(v.z))); }

// Nested uniform (Owen) scrambling of a bit-reversed number: Laine and Karras 2011, with the constants of
// Vegdahl 2021 ("Owen scrambling, building a better LK hash").
uint owen_scramble_reversed(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

uint owen_scramble(uint x, uint seed) { return bitfieldReverse(owen_scramble_reversed(bitfieldReverse(x), seed)); }

// The second Sobol dimension without a table, its bits reversed: multiplication by the Pascal matrix over GF(2) in five
// steps (Ahmed 2024).
uint sobol_second_dimension_reversed(uint index) {
  index ^= index >> 16;
  index ^= (index & 0xff00ff00u) >> 8;
  index ^= (index & 0xf0f0f0f0u) >> 4;
  index ^= (index & 0xccccccccu) >> 2;
  index ^= (index & 0xaaaaaaaau) >> 1;
  return index;
}

float unit_interval(uint bits) { return float(bits >> 8) * (1.0 / 16777216.0); }  // [0, 1)

// Point `index` of an Owen-scrambled, shuffled Sobol (0,2)-sequence: Burley 2020, "Practical hash-based Owen scrambling".
// Different seeds give independent sequences, so that further dimensions are further calls.
// Of the scrambled numbers only the reversed bits are made, for a software device takes long to reverse them.
vec2 sobol_2d(uint index, uint seed) {
  const uint shuffled = owen_scramble(index, hash(seed));
  const uint first = bitfieldReverse(owen_scramble_reversed(shuffled, hash(seed ^ 0xa511e9b3u)));
  const uint second =
      bitfieldReverse(owen_scramble_reversed(sobol_second_dimension_reversed(shuffled), hash(seed ^ 0x63d83595u)));
  return vec2(unit_interval(first), unit_interval(second));
}

float sobol_1d(uint index, uint seed) {
  const uint shuffled = owen_scramble(index, hash(seed));
  return unit_interval(bitfieldReverse(owen_scramble_reversed(shuffled, hash(seed ^ 0xa511e9b3u))));
}

// Direction with density cos(theta) / pi about +Z: Malley's method over the concentric disk map (Shirley and Chiu 1997).
vec3 cosine_hemisphere(vec2 u) {
  const vec2 square = 2.0 * u - 1.0;
  const bool wide = abs(square.x) > abs(square.y);
  const float radius = wide ? square.x : square.y;
  const float ratio = wide ? square.y / square.x : (square.y != 0.0 ? square.x / square.y : 0.0);
  const float phi = wide ? (kPi / 4.0) * ratio : kPi / 2.0 - (kPi / 4.0) * ratio;
  const vec2 disk = radius * vec2(cos(phi), sin(phi));
  return vec3(disk, sqrt(max(0.0, 1.0 - dot(disk, disk))));
}
