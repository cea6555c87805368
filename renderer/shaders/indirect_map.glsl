// Which pixel of the picture stands for a pixel of the indirect map, and which patch it belongs to. Needs bindings.

uniform ivec2 indirect_size_px;
uniform vec2 indirect_scale;    // picture pixels per map pixel
uniform vec2 indirect_jitter;   // [0, 1): where in its block the representative lies; 0.5 is the middle

ivec2 representative_pixel(ivec2 map_pixel) {
  return ivec2((vec2(map_pixel) + indirect_jitter) * indirect_scale);
}

// Patches are squares of 1, 2, 4, 8 or 16 pixels of the map. Interleaved sampling (Keller and Heidrich 2001): the patches of
// a 4 x 4 tile have different directions, patches at the same place of their tiles the same. Slots put those of a block's
// tiles side by side: their rays run together, which a tracer of packets rewards, and neighbours stay uncorrelated, which a
// filter does. The pixels of a patch have consecutive slots.
const int kTileSide = 4;    // patches
const int kBlockSide = 16;  // pixels
const uint kBlockSlots = 256u;

// Only blocks that see a surface have slots; see passes/active_blocks.comp. Element n: the block with rank n, and the rank
// of block n.
layout(binding = UNIT_ACTIVE_BLOCKS) uniform usamplerBuffer active_blocks;
const uint kNoRank = 0xffffffffu;

uniform uint slot_count;       // pixels: 256 for each active block; some lie outside the map
uniform int log2_patch_side;   // pixels

int log2_tiles() { return max(2 - log2_patch_side, 0); }       // of a block's side
int log2_places() { return min(4 - log2_patch_side, 2); }      // of a tile's side within a block

// The patch's index within its block, from its place there, and back.
uint index_of_patch(ivec2 patch_in_block) {
  const ivec2 place = patch_in_block & (kTileSide - 1), tile = patch_in_block >> 2;
  return uint((place.y << log2_places() | place.x) << (2 * log2_tiles()) | tile.y << log2_tiles() | tile.x);
}
ivec2 patch_of_index(int index) {
  const int tile = index & ((1 << 2 * log2_tiles()) - 1), place = index >> (2 * log2_tiles());
  return ivec2(place & ((1 << log2_places()) - 1), place >> log2_places()) +
         kTileSide * ivec2(tile & ((1 << log2_tiles()) - 1), tile >> log2_tiles());
}

ivec2 block_origin(uint rank) {
  const int blocks_x = (indirect_size_px.x + kBlockSide - 1) / kBlockSide;
  const int block = int(texelFetch(active_blocks, int(rank)).x);
  return ivec2(block % blocks_x, block / blocks_x) * kBlockSide;
}

ivec2 pixel_of_slot(uint slot) {
  const int in_block = int(slot % kBlockSlots);
  const int in_patch = in_block & ((1 << 2 * log2_patch_side) - 1);
  const ivec2 patch_in_block = patch_of_index(in_block >> (2 * log2_patch_side));
  return block_origin(slot / kBlockSlots) + (patch_in_block << log2_patch_side) +
         ivec2(in_patch & ((1 << log2_patch_side) - 1), in_patch >> log2_patch_side);
}

// kNoRank where the pixel's block has none.
uint slot_of_pixel(ivec2 pixel) {
  const int blocks_x = (indirect_size_px.x + kBlockSide - 1) / kBlockSide;
  const ivec2 block = pixel / kBlockSide, in_block = pixel % kBlockSide;
  const uint rank = texelFetch(active_blocks, block.y * blocks_x + block.x).y;
  if (rank == kNoRank) return kNoRank;
  const ivec2 in_patch = in_block & ((1 << log2_patch_side) - 1);
  return rank * kBlockSlots + (index_of_patch(in_block >> log2_patch_side) << 2 * log2_patch_side) +
         uint(in_patch.y << log2_patch_side | in_patch.x);
}

// Which of the 16 sets of directions a patch has, by its place in the map.
uint direction_set(ivec2 patch_in_map) {
  const ivec2 place = patch_in_map & (kTileSide - 1);
  return uint(place.y * kTileSide + place.x);
}
