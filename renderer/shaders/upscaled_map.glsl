// The indirect map at a pixel. Needs bindings, packing, g_buffer.

layout(binding = UNIT_IMAGE_B) uniform sampler2D indirect_map;

struct MapSample {
  vec4 light;    // over directional albedo; weighted, by a
  bool matched;  // false: it is of other surfaces than the pixel's
};

#ifdef JOINT_UPSCALE
layout(binding = UNIT_GUIDE) uniform usampler2D guide;  // see indirect_filter.comp

// Joint bilateral upsampling (Kopf et al. 2007): of the four texels around, those on the pixel's own surface count. Not in
// the thesis; goes with its filter.
MapSample upscaled_map(GBufferPoint point, vec2 uv) {
  const ivec2 size = textureSize(indirect_map, 0);
  const vec2 position = uv * vec2(size) - 0.5;
  const vec2 fraction = position - floor(position);
  const float plane_scale = 1.0 / (0.01 * point.view_depth_m);
  MapSample map = MapSample(vec4(0.0), false);
  for (int i = 0; i < 4; ++i) {
    const ivec2 corner = ivec2(i & 1, i >> 1);
    const ivec2 texel = clamp(ivec2(floor(position)) + corner, ivec2(0), size - 1);
    const uvec4 there = texelFetch(guide, texel, 0);
    const vec3 normal_ws = unpack_normal_roughness(there.w).xyz;
    const float off_plane = abs(dot(uintBitsToFloat(there.xyz) - point.position_ws, point.normal_ws)) * plane_scale;
    const float facing = max(dot(normal_ws, point.normal_ws), 0.0);
    const vec2 bilinear = mix(1.0 - fraction, fraction, vec2(corner));
    // A little of plain bilinear remains, for pixels none of whose texels is similar.
    const float weight = (bilinear.x * bilinear.y + 1e-3) * (facing * facing * facing * facing * exp2(-off_plane) + 1e-4);
    map.light += weight * texelFetch(indirect_map, texel, 0);
    map.matched = map.matched || (off_plane < 1.0 && facing > 0.7);
  }
  return map;
}
#else
MapSample upscaled_map(GBufferPoint point, vec2 uv) { return MapSample(textureLod(indirect_map, uv, 0.0), true); }
#endif

// Light for the eye, from the map's.
vec3 modulated(GBufferPoint point, vec4 light) {
  const vec3 albedo = directional_albedo(point.brdf, max(dot(point.normal_ws, point.to_camera_ws), 0.0));
  return light.rgb / max(light.a, 1e-7) * max(albedo, vec3(1e-4));
}
