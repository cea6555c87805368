// What a ray sees that hits nothing. Needs bindings and sampling (kPi).

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

struct Sky {
  vec3 zenith_radiance, horizon_radiance, ground_radiance;
  float strength;
};

// For loops: a software device would load the block anew at every turn.
Sky load_sky() {
  return Sky(environment.zenith_radiance.rgb, environment.horizon_radiance.rgb, environment.ground_radiance.rgb,
             environment.horizon_radiance.w);
}

vec3 sky_radiance(Sky sky, vec3 direction_ws) {
#ifdef HAS_ENVIRONMENT_IMAGE
  if (environment.ground_radiance.w > 0.5) {
    return textureLod(environment_image, environment_uv(direction_ws), 0.0).rgb * sky.strength;
  }
#endif
  const float up = direction_ws.y;
  const vec3 above = mix(sky.horizon_radiance, sky.zenith_radiance, sqrt(max(up, 0.0)));
  const vec3 below = mix(sky.horizon_radiance, sky.ground_radiance, smoothstep(0.0, 0.15, -up));
  return (up >= 0.0 ? above : below) * sky.strength;
}

vec3 environment_radiance(vec3 direction_ws) { return sky_radiance(load_sky(), direction_ws); }

vec3 background_radiance(vec3 direction_ws) {
  return environment.background.w > 0.5 ? environment.background.rgb : environment_radiance(direction_ws);
}
