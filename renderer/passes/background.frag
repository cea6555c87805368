// What the camera sees where there is no surface, into the picture that compose.frag fills elsewhere.
#include "passes/bindings.glsl"
#include "shaders/sampling.glsl"
#include "shaders/camera.glsl"
#include "shaders/environment.glsl"
#include "shaders/finite.glsl"

layout(location = 0) out vec4 picture;  // a: 0, so that the background does not count in the exposure

uniform int shown;  // 0 in the views that are of surfaces alone

void main() {
  const vec3 radiance = background_radiance(normalize(camera_ray_ws(gl_FragCoord.xy)));
  picture = finite_light(vec4(shown == 1 ? radiance : vec3(0.0), 0.0));
}
