// An edge-stopping a-trous step over the indirect map: Dammertz et al. 2010. Not in the thesis; it takes the noise of few
// directions out before the map is scaled up. The map is demodulated, so that textures are not blurred.
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/indirect_map.glsl"

layout(rgba32f, binding = 0) writeonly uniform image2D filtered;
layout(binding = UNIT_IMAGE_A) uniform sampler2D indirect_map;

uniform int stride;  // pixels between taps: 1, 2, 4, ...

const float kNormalPower = 32.0;
const float kPlaneTolerance = 0.02;  // distance from the centre's plane, relative to its depth

void main() {
  const ivec2 map_pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(map_pixel, indirect_size_px))) return;
  const GBufferPoint center = g_buffer_point(representative_pixel(map_pixel));
  const float kernel[3] = float[](0.375, 0.25, 0.0625);  // B3 spline
  vec4 sum = vec4(0.0);
  float weight_sum = 0.0;
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x) {
      const ivec2 tap = map_pixel + ivec2(x, y) * stride;
      const ivec2 inside = clamp(tap, ivec2(0), indirect_size_px - 1);
      const vec4 value = texelFetch(indirect_map, inside, 0);
      const GBufferPoint other = g_buffer_point(representative_pixel(inside));
      const float off_plane = abs(dot(other.position_ws - center.position_ws, center.geometric_normal_ws));
      const float similar_normal = pow(max(dot(center.normal_ws, other.normal_ws), 0.0), kNormalPower);
      const float on_plane = exp(-off_plane / (kPlaneTolerance * center.view_depth_m));
      const float similar_gloss = exp(-8.0 * abs(sqrt(center.brdf.alpha) - sqrt(other.brdf.alpha)));
      const float there = inside == tap && value.a > 0.5 ? 1.0 : 0.0;
      const float weight = kernel[abs(x)] * kernel[abs(y)] * similar_normal * on_plane * similar_gloss * there;
      sum += weight * value;
      weight_sum += weight;
    }
  const vec4 value = weight_sum > 0.0 ? sum / weight_sum : texelFetch(indirect_map, map_pixel, 0);
  imageStore(filtered, map_pixel, center.valid ? vec4(value.rgb, 1.0) : vec4(0.0));
}
