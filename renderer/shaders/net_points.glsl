// Random numbers for texels side by side whose errors are blue noise: what one misses its neighbours find. Needs sampling.
// The places in a block of 4 x 4 texels (along a Z), the numbers of a texel's samples, and both coordinates are the axes of
// one (0,7,4)-net in base 4 (Faure 1982, over GF(4)). So the samples of a texel in 4, 16, ... numbers from a multiple of as
// many, those of 2 x 2 or 4 x 4 texels with the same numbers, and both together, are nets in the unit square. Pixels along a
// Z that share a sequence are from Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of Monte Carlo sampling error
// via hierarchical ordering of pixels"; here time is an axis as well.

struct NetPlace {
  uint seed;      // of the block
  uint in_block;  // four bits, the most significant first: of y and x, which of the halves; and which in those
};

NetPlace net_place(uvec2 texel, uint seed) {
  const uint in_block = (texel.y >> 1 & 1u) | (texel.x & 2u) | (texel.y & 1u) << 2 | (texel.x & 1u) << 3;
  return NetPlace(hash(uvec3(texel >> 2u, seed)), in_block);
}

// What each bit of a number and of a place, the most significant first, contributes to x (low half) and y (high half) of the
// net's points; in both the most significant bit is the lowest. The Pascal matrix to the powers 0, 1, w and w^2 of GF(4)
// gives the axes' digits (number, place, x, y) of a point's index: here solved for x and y.
const uint kNetOfNumber[10] = uint[10](0x13201230u, 0x21302310u, 0x060d0709u, 0x0b06090eu, 0x13321223u,
                                       0x21132331u, 0x06660777u, 0x0bbb0999u, 0x12231332u, 0x23312113u);
const uint kNetOfPlace[4] = uint[4](0x13211231u, 0x21322312u, 0x152a153fu, 0x2a3f2a15u);

uint net_word(uint number, uint in_block) {
  uint word = 0u;
  for (int i = 0; i < 10; ++i) word ^= (number >> i & 1u) != 0u ? kNetOfNumber[i] : 0u;
  for (int i = 0; i < 4; ++i) word ^= (in_block >> i & 1u) != 0u ? kNetOfPlace[i] : 0u;
  return word;
}

// Point `number` of the texel's sequence for a decision. All four axes are scrambled (Owen 1995), each decision's otherwise,
// so that decisions are independent. After 1024 numbers another net begins.
vec2 net_2d(NetPlace place, uint number, uint decision) {
  const uint seed = hash(place.seed + decision * 0x9e3779b9u + (number >> 10) * 0x85ebca6bu);
  const uint shuffled = owen_scramble_reversed(bitfieldReverse(number) >> 22, seed);
  const uint word = net_word(shuffled, owen_scramble_reversed(place.in_block, seed ^ 0x68bc21ebu));
  const uint first = bitfieldReverse(owen_scramble_reversed(word & 0xffffu, hash(seed ^ 0xa511e9b3u)));
  const uint second = bitfieldReverse(owen_scramble_reversed(word >> 16, hash(seed ^ 0x63d83595u)));
  return vec2(unit_interval(first), unit_interval(second));
}

float net_1d(NetPlace place, uint number, uint decision) { return net_2d(place, number, decision).x; }
