// Exposure, tone curve and sRGB: eight bits a channel. Not in compute: a software device stores to buffers lane by lane.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/tone_map.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D picture;
flat in float scale;  // by the exposure
layout(location = 0) out vec4 display;

uniform int mapping;        // 0 exposed and tone-mapped, 1 as it is, 2 distance, 3 repeats each unit, 4 from -1 to 1
uniform int neutral_curve;  // 1: Khronos PBR Neutral; 0: cut off at 1

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const vec4 value = texelFetch(picture, pixel, 0);
  vec3 color = value.rgb * scale;
  if (neutral_curve == 1) color = tone_map_pbr_neutral(color);
  if (mapping == 1 || value.a < -0.5) color = value.rgb;
  if (mapping == 2) color = value.r > 0.0 ? vec3(1.0 / (1.0 + 4.0 * value.r * scale)) : vec3(0.0);
  if (mapping == 3) color = fract(value.rgb);
  if (mapping == 4) color = value.rgb * 0.5 + 0.5;
  // Half a step of noise hides the steps of eight bits in dark gradients.
  const float noise = unit_interval(hash(uint(pixel.y << 16 | pixel.x))) - 0.5;
  display = vec4(srgb_from_linear(color) + noise / 255.0, 1.0);
}
