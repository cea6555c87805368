// Exposure, tone curve and sRGB: eight bits a channel into a buffer the encoder reads.
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/tone_map.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D picture;
layout(std430, binding = BINDING_EXPOSURE) readonly buffer Exposure {
  float exposure;
  float exposure_ev;
  uint measured;
};
layout(std430, binding = BINDING_OUTPUT) writeonly buffer Display { uint display_rgbx[]; };

uniform ivec2 size_px;
uniform int mapping;          // 0 exposed and tone-mapped, 1 as it is, 2 distance, 3 repeats each unit, 4 from -1 to 1
uniform int neutral_curve;    // 1: Khronos PBR Neutral; 0: cut off at 1
uniform float fixed_exposure; // above 0: used instead of the measured one

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size_px))) return;
  const vec4 value = texelFetch(picture, pixel, 0);
  const float scale = fixed_exposure > 0.0 ? fixed_exposure : exposure;
  vec3 color = value.rgb * scale;
  if (neutral_curve == 1) color = tone_map_pbr_neutral(color);
  if (mapping == 1 || value.a < -0.5) color = value.rgb;
  if (mapping == 2) color = value.r > 0.0 ? vec3(1.0 / (1.0 + 4.0 * value.r * scale)) : vec3(0.0);
  if (mapping == 3) color = fract(value.rgb);
  if (mapping == 4) color = value.rgb * 0.5 + 0.5;
  // Half a step of noise hides the steps of eight bits in dark gradients.
  const float noise = unit_interval(hash(uint(pixel.y << 16 | pixel.x))) - 0.5;
  const uvec3 bytes = uvec3(clamp(srgb_from_linear(color) * 255.0 + 0.5 + noise, 0.0, 255.0));
  display_rgbx[pixel.y * size_px.x + pixel.x] = bytes.r | bytes.g << 8 | bytes.b << 16 | 0xff000000u;
}
