// The light of a wave's paths into their pixels; blending averages with the samples before.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/path.glsl"
#include "shaders/finite.glsl"

layout(binding = UNIT_PATH_RADIANCE) uniform samplerBuffer radiance;
layout(location = 0) out vec4 picture;

void main() {
  const uint index = uint(gl_FragCoord.y) * uint(picture_width_px) + uint(gl_FragCoord.x) - first_pixel;
  picture = finite_light(texelFetch(radiance, int(index)));
}
