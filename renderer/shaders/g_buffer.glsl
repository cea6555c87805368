// Reading the G-buffer; the C++ side is renderer/passes/g_buffer.h. Needs bindings, packing, brdf, camera.
// REFRACTED: what passes the surface of a volume is not shown by another layer, but found by a ray.

layout(binding = UNIT_G_SURFACE) uniform usampler2D g_surface;    // normal, geometric normal, base colour, metallic
layout(binding = UNIT_G_MATERIAL) uniform usampler2D g_material;  // material | roughness << 16, f0 and specular factor of the dielectric
layout(binding = UNIT_G_EMISSION) uniform sampler2D g_emission;   // nit
layout(binding = UNIT_G_DEPTH) uniform sampler2D g_depth;         // reversed; 0: nothing there

#ifdef HAS_LOBES
#include "shaders/lobes.glsl"
layout(binding = UNIT_G_LOBES) uniform usampler2D g_lobes;
#endif

struct GBufferPoint {
  bool valid;                // false: background
  float view_depth_m;
  vec3 position_ws;
  vec3 normal_ws;            // shading normal, on the viewer's side
  vec3 geometric_normal_ws;  // on the viewer's side
  vec3 to_camera_ws;         // unit
  uint material;
  Brdf brdf;
};

GBufferPoint g_buffer_point(ivec2 pixel) {
  GBufferPoint point;
  const float depth = texelFetch(g_depth, pixel, 0).r;
  point.valid = depth > 0.0;
  const uvec4 surface = texelFetch(g_surface, pixel, 0);
  const uvec2 packed_material = texelFetch(g_material, pixel, 0).rg;
  const float safe_depth = point.valid ? depth : 1.0;
  point.view_depth_m = view_depth(safe_depth);
  point.position_ws = position_from_depth(vec2(pixel) + 0.5, safe_depth);
  point.to_camera_ws = direction_to_camera(point.position_ws);
  point.normal_ws = unit_from_octahedral(unpackSnorm2x16(surface.x));
  point.geometric_normal_ws = unit_from_octahedral(unpackSnorm2x16(surface.y));
  const vec2 blue_metallic = unpackUnorm2x16(surface.w);
  const vec3 base_color = vec3(unpackUnorm2x16(surface.z), blue_metallic.x);
  point.material = packed_material.x & 0xffffu;
  const float roughness = float(packed_material.x >> 16) / 65535.0;
  const vec2 dielectric = unpackUnorm2x16(packed_material.y);
  point.brdf = make_brdf(base_color, blue_metallic.y, roughness, dielectric.x, dielectric.y);
#ifdef HAS_LOBES
  const uvec4 lobes = texelFetch(g_lobes, pixel, 0);
  point.brdf = with_lobes(point.brdf, base_color, blue_metallic.y, unpack_g_lobes(lobes, dielectric),
                          max(g_lobes_eta(lobes), 1e-3));
#ifdef REFRACTED
  const bool shown_elsewhere = (lobes.w & kNothingPasses) != 0u && point.brdf.eta == 1.0;
#else
  const bool shown_elsewhere = (lobes.w & kNothingPasses) != 0u;
#endif
  if (shown_elsewhere) point.brdf.transmission_color = vec3(0.0);
#endif
  return point;
}

// How far to lift a ray off the surface: well over the rounding of depth and position, well under what can be seen.
float ray_offset_m(GBufferPoint point) {
  const vec3 extent = abs(point.position_ws);
  return 2e-4 * point.view_depth_m + 1e-6 * max(extent.x, max(extent.y, extent.z));
}
