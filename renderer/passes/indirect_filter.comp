// An edge-stopping a-trous step over the indirect map: Dammertz et al. 2010. Not in the thesis; it takes the noise of few
// directions out before the map is scaled up. The map is demodulated, so that textures are not blurred.
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/camera.glsl"

layout(rgba32f, binding = 0) writeonly uniform image2D filtered;
layout(binding = UNIT_IMAGE_A) uniform sampler2D indirect_map;
layout(binding = UNIT_IMAGE_B) uniform usampler2D guide;  // position, normal and roughness of the gathered points

uniform int stride;  // pixels between taps: 1, 2, 4, ...

const float kPlaneTolerance = 0.02;  // distance from the centre's plane, relative to its distance from the eye

void main() {
  const ivec2 map_pixel = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 size = imageSize(filtered);
  if (any(greaterThanEqual(map_pixel, size))) return;
  const uvec4 here = texelFetch(guide, map_pixel, 0);
  const vec3 position_ws = uintBitsToFloat(here.xyz);
  const vec4 normal_roughness = unpack_normal_roughness(here.w);
  const float plane_scale = 1.0 / (kPlaneTolerance * max(distance(position_ws, camera.eye_ws.xyz), 1e-6));
  const float kernel[3] = float[](0.375, 0.25, 0.0625);  // B3 spline
  vec4 sum = vec4(0.0);
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x) {
      const ivec2 tap = map_pixel + ivec2(x, y) * stride;
      const ivec2 inside = clamp(tap, ivec2(0), size - 1);
      const vec4 value = texelFetch(indirect_map, inside, 0);
      const uvec4 there = texelFetch(guide, inside, 0);
      const vec4 other = unpack_normal_roughness(there.w);
      const float off_plane = abs(dot(uintBitsToFloat(there.xyz) - position_ws, normal_roughness.xyz)) * plane_scale;
      float similar_normal = max(dot(normal_roughness.xyz, other.xyz), 0.0);
      for (int i = 0; i < 5; ++i) similar_normal *= similar_normal;  // to the power of 32
      const float similar = similar_normal * exp2(-1.44 * off_plane - 12.0 * abs(normal_roughness.w - other.w));
      sum += kernel[abs(x)] * kernel[abs(y)] * similar * (inside == tap ? 1.0 : 0.0) * value;
    }
  // Premultiplied: the validity of the taps is the sum of their weights.
  const vec4 center = texelFetch(indirect_map, map_pixel, 0);
  imageStore(filtered, map_pixel, center.a < 0.5 ? vec4(0.0) : vec4(sum.a > 0.0 ? sum.rgb / sum.a : center.rgb, 1.0));
}
