// What the camera sees where there is no surface, into the picture that compose.frag fills elsewhere. OVER_BEHIND: where
// there is no clear surface, the picture behind them; volumes absorb even where only their backs are seen.
#include "passes/bindings.glsl"
#include "shaders/sampling.glsl"
#define FLAT_CAMERA
#include "shaders/camera.glsl"
#include "shaders/environment.glsl"
#include "shaders/finite.glsl"

layout(location = 0) out vec4 picture;  // a: 0, so that the background does not count in the exposure

uniform int shown;  // 0 in the views that are of surfaces alone

#ifdef OVER_BEHIND
layout(binding = UNIT_BEHIND) uniform sampler2D behind;
layout(binding = UNIT_CLEAR_LAYERS) uniform sampler2D clear_layers;
uniform int tinted;  // 0 in the views that are not of light

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  picture = texelFetch(behind, pixel, 0);
  if (tinted == 1) picture.rgb *= exp(-max(texelFetch(clear_layers, pixel, 0).rgb, 0.0));
}
#else
void main() {
  const vec3 radiance = background_radiance(normalize(camera_ray_ws(gl_FragCoord.xy)));
  picture = finite_light(vec4(shown == 1 ? radiance : vec3(0.0), 0.0));
}
#endif
