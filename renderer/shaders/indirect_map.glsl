// Which pixel of the picture stands for a pixel of the indirect map. Needs bindings, sampling.

uniform ivec2 indirect_size_px;
uniform vec2 indirect_scale;    // picture pixels per map pixel
uniform vec2 indirect_jitter;   // [0, 1): where in its block the representative lies; 0.5 is the middle

ivec2 representative_pixel(ivec2 map_pixel) {
  return ivec2((vec2(map_pixel) + indirect_jitter) * indirect_scale);
}

// Interleaved sampling (Keller and Heidrich 2001): the pixels of a 4 x 4 tile have different directions, pixels at the same
// place of their tiles the same. Slots put 16 of the latter, from 4 x 4 tiles, side by side: their rays run together,
// which a tracer of packets rewards, and neighbours stay uncorrelated, which a filter does.
const int kTileSide = 4;
const int kBlockSide = 16;  // 4 x 4 tiles

// Only blocks that see a surface have slots; see passes/active_blocks.comp. Element n: the block with rank n, and the rank
// of block n.
layout(binding = UNIT_ACTIVE_BLOCKS) uniform usamplerBuffer active_blocks;
const uint kNoRank = 0xffffffffu;

uniform uint slot_count;  // 256 for each active block; some lie outside the map

ivec2 pixel_of_slot(uint slot) {
  const int blocks_x = (indirect_size_px.x + kBlockSide - 1) / kBlockSide;
  const int block = int(texelFetch(active_blocks, int(slot) / (kBlockSide * kBlockSide)).x);
  const int place = int(slot) / 16 % 16;  // in its tile
  const int tile = int(slot) % 16;        // in its block
  return ivec2(block % blocks_x, block / blocks_x) * kBlockSide + ivec2(tile % 4, tile / 4) * kTileSide +
         ivec2(place % 4, place / 4);
}

// kNoRank where the pixel's block has none.
uint slot_of_pixel(ivec2 pixel) {
  const int blocks_x = (indirect_size_px.x + kBlockSide - 1) / kBlockSide;
  const ivec2 block = pixel / kBlockSide;
  const ivec2 tile = pixel % kBlockSide / kTileSide;
  const ivec2 place = pixel % kTileSide;
  const uint rank = texelFetch(active_blocks, block.y * blocks_x + block.x).y;
  if (rank == kNoRank) return kNoRank;
  return (rank * 16u + uint(place.y * 4 + place.x)) * 16u + uint(tile.y * 4 + tile.x);
}
