// isSimilar of the thesis (5.1) over the pixels of the indirect map. Needs bindings, packing, camera, indirect_map, patches.
layout(binding = UNIT_G_SURFACE) uniform usampler2D g_surface;
layout(binding = UNIT_G_MATERIAL) uniform usampler2D g_material;
layout(binding = UNIT_G_DEPTH) uniform sampler2D g_depth;

uniform float normal_threshold;  // least cosine between the normals
uniform float depth_threshold;   // greatest difference of the depths in camera space, relative to the greater

const float kLobeWidths = 2.0;  // that normals may lie apart

// Beyond the thesis, whose surfaces are matt: where normals lie farther apart than those of a smooth surface's
// microfacets, the lobes hardly overlap, and a direction that is rare for a patch would be a bright speck for its pixel.
float least_cosine_of_lobes(float roughness) {
  const float alpha = max(roughness * roughness, 0.0016);
  return 1.0 - 0.5 * kLobeWidths * kLobeWidths * alpha * alpha;
}

bool is_similar(PatchPoint a, PatchPoint b) {
  const float difference = abs(a.view_depth_m - b.view_depth_m);
  const float limit = depth_threshold * max(a.view_depth_m, b.view_depth_m);
#ifdef LITERAL_SIMILARITY
  const bool depths_agree = difference > limit;  // as printed
  const float least_cosine = normal_threshold;
#else
  const bool depths_agree = difference < limit;
  const float least_cosine = max(normal_threshold, least_cosine_of_lobes(min(a.roughness, b.roughness)));
#endif
  return a.valid && b.valid && a.material == b.material && depths_agree && dot(a.normal_ws, b.normal_ws) > least_cosine;
}

bool is_inside(ivec2 map_pixel) {
  return all(greaterThanEqual(map_pixel, ivec2(0))) && all(lessThan(map_pixel, indirect_size_px));
}
ivec2 pixel_within(ivec2 map_pixel) {
  return representative_pixel(clamp(map_pixel, ivec2(0), indirect_size_px - 1));
}

bool sees_surface(ivec2 map_pixel) {
  return texelFetch(g_depth, pixel_within(map_pixel), 0).r > 0.0 && is_inside(map_pixel);
}

// A pixel of the map as a patch of its own; not valid outside the map and where nothing is seen.
PatchPoint point_of_pixel(ivec2 map_pixel) {
  const ivec2 pixel = pixel_within(map_pixel);
  const float depth = texelFetch(g_depth, pixel, 0).r;
  const float safe_depth = depth > 0.0 ? depth : 1.0;
  const uint material_roughness = texelFetch(g_material, pixel, 0).x;
  return PatchPoint(is_inside(map_pixel) && depth > 0.0, map_pixel, position_from_depth(vec2(pixel) + 0.5, safe_depth),
                    unit_from_octahedral(unpackSnorm2x16(texelFetch(g_surface, pixel, 0).x)), view_depth(safe_depth),
                    material_roughness & 0xffffu, float(material_roughness >> 16) / 65535.0);
}
