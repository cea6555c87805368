// What a ray sees that hits nothing. Needs bindings and sampling (kPi).
#include "shaders/sky_gradient.glsl"

layout(std140, binding = BINDING_ENVIRONMENT) uniform EnvironmentBlock {
  vec4 zenith_radiance;   // w: rotation about +Y, radians
  vec4 horizon_radiance;  // w: strength
  vec4 ground_radiance;   // w: 1 if there is an image
  vec4 background;        // what the camera sees instead; w: 1 if set
} environment;

#ifdef HAS_ENVIRONMENT_IMAGE
layout(binding = UNIT_ENVIRONMENT) uniform sampler2D environment_image;  // latitude-longitude, row 0 the zenith
#endif

// Where a direction lies in the latitude-longitude picture, and the way back.
vec2 environment_uv(vec3 direction_ws) {
  const float longitude = atan(direction_ws.x, -direction_ws.z) + environment.zenith_radiance.w;
  return vec2(longitude / (2.0 * kPi) + 0.5, acos(clamp(direction_ws.y, -1.0, 1.0)) / kPi);
}

vec3 environment_direction(float column_uv, float up) {
  const float longitude = (column_uv - 0.5) * (2.0 * kPi) - environment.zenith_radiance.w;
  const float sin_theta = sqrt(max(1.0 - up * up, 0.0));
  return vec3(sin_theta * sin(longitude), up, -sin_theta * cos(longitude));
}

vec3 environment_radiance(vec3 direction_ws) {
#ifdef HAS_ENVIRONMENT_IMAGE
  if (environment.ground_radiance.w > 0.5) {
    return textureLod(environment_image, environment_uv(direction_ws), 0.0).rgb * environment.horizon_radiance.w;
  }
#endif
  return sky_gradient(environment.zenith_radiance.rgb, environment.horizon_radiance.rgb, environment.ground_radiance.rgb,
                      direction_ws.y) *
         environment.horizon_radiance.w;
}

vec3 background_radiance(vec3 direction_ws) {
  return environment.background.w > 0.5 ? environment.background.rgb : environment_radiance(direction_ws);
}
