// The light of a wave's paths into their pixels; blending averages with the samples before.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/path.glsl"

layout(binding = UNIT_PATH_RADIANCE) uniform samplerBuffer radiance;
layout(location = 0) out vec4 picture;

// No light of a scene comes near it: what is greater, infinite or not a number is an overflow of extreme values given.
const float kGreatestRadiance = 1e36;

void main() {
  const uint index = uint(gl_FragCoord.y) * uint(picture_width_px) + uint(gl_FragCoord.x) - first_pixel;
  const vec4 light = texelFetch(radiance, int(index));
  picture = mix(vec4(0.0), clamp(light, -1.0, kGreatestRadiance), equal(light, light));
}
