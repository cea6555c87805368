// The picture that a still view showed last, and the paths of `reference` that take its place.
#include "passes/bindings.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D paths;
layout(binding = UNIT_IMAGE_B) uniform sampler2D shown_before;

uniform float share;  // of the paths
layout(location = 0) out vec4 picture;

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  picture = mix(texelFetch(shown_before, pixel, 0), texelFetch(paths, pixel, 0), share);
}
