// Which pixel of the picture stands for a pixel of the indirect map. Needs sampling.

uniform ivec2 indirect_size_px;
uniform vec2 indirect_scale;    // picture pixels per map pixel
uniform vec2 indirect_jitter;   // [0, 1): where in its block the representative lies; 0.5 is the middle

ivec2 representative_pixel(ivec2 map_pixel) {
  return ivec2((vec2(map_pixel) + indirect_jitter) * indirect_scale);
}
