// The ray of each record of the occlusion map: record = j * slot_count + the pixel's slot. Needs bindings, ray.
// PATCHES: the pixel's own origin and the direction of the patch it refers to.

uniform uint slot_count;

#ifdef PATCHES
layout(binding = UNIT_PIXEL_ORIGINS) uniform usamplerBuffer pixel_origins;  // 2 texels a slot, see number_unmatched.comp
layout(binding = UNIT_DIRECTIONS) uniform samplerBuffer directions;        // patch by patch, with the pdf
uniform uint patch_count;

Ray occlusion_ray(uint record) {
  const uint slot = record % slot_count;
  const uvec4 origin = texelFetch(pixel_origins, int(2u * slot));
  const vec3 direction_ws = texelFetch(directions, int(record / slot_count * patch_count + origin.w)).xyz;
  const vec3 down_ws = uintBitsToFloat(texelFetch(pixel_origins, int(2u * slot + 1u)).xyz);
  const bool below = dot(direction_ws, down_ws) > 0.0;
  return Ray(uintBitsToFloat(origin.xyz) + (below ? down_ws : vec3(0.0)), 0.0, direction_ws, 1e30);
}
#else
layout(binding = UNIT_RAYS) uniform samplerBuffer ray_texels;  // 2 texels a ray

Ray occlusion_ray(uint record) {
  const vec4 origin = texelFetch(ray_texels, int(2u * record));
  const vec4 direction = texelFetch(ray_texels, int(2u * record + 1u));
  return Ray(origin.xyz, origin.w, direction.xyz, direction.w);
}
#endif
