// One triangle that covers the viewport, and the exposure: read here, for a software device reads it once a lane in every
// fragment shader.
#include "passes/bindings.glsl"

layout(binding = UNIT_IMAGE_B) uniform samplerBuffer measured_exposure;  // linear scale; see exposure.comp

uniform float fixed_exposure;  // above 0: used instead of the measured one

flat out float scale;

void main() {
  scale = fixed_exposure > 0.0 ? fixed_exposure : texelFetch(measured_exposure, 0).r;
  const vec2 corner = vec2((gl_VertexID & 1) != 0 ? 3.0 : -1.0, (gl_VertexID & 2) != 0 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
