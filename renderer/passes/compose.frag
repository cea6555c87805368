// One scene-referred picture: emission and direct light through the variance shadow maps (thesis 4.1), and the indirect
// map scaled up bilinearly (thesis 5.3) and multiplied with the directional albedo it was divided by; or one of the
// views. Blending averages with earlier frames.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/lights.glsl"
#include "shaders/environment.glsl"

layout(location = 0) out vec4 picture;  // a: 1 on lit surfaces, 0 on the background, -1 on unlit surfaces
layout(binding = UNIT_IMAGE_B) uniform sampler2D indirect_map;
layout(binding = UNIT_IMAGE_C) uniform sampler2D occlusion_distance;

uniform int view;  // ViewKind

const int kFinal = 0, kDirect = 1, kIndirect = 2, kAlbedo = 3, kNormal = 4, kDepth = 5, kOcclusionDistance = 6;

vec3 direct_light(ivec2 pixel, GBufferPoint point) {
  return texelFetch(g_emission, pixel, 0).rgb +
         reflected_punctual_light(point.brdf, point.position_ws, point.normal_ws, point.geometric_normal_ws,
                                  point.to_camera_ws);
}

vec3 indirect_light(GBufferPoint point, vec2 uv) {
  const vec4 demodulated = textureLod(indirect_map, uv, 0.0);
  const vec3 albedo = directional_albedo(point.brdf, max(dot(point.normal_ws, point.to_camera_ws), 0.0));
  return demodulated.rgb / max(demodulated.a, 1e-3) * max(albedo, vec3(1e-4));
}

#ifdef AUXILIARY_VIEWS
vec3 surface_value(ivec2 pixel, GBufferPoint point, vec2 uv) {
  switch (view) {
    case kAlbedo: return point.brdf.diffuse_albedo + point.brdf.f0;
    case kNormal: return point.normal_ws * 0.5 + 0.5;
    case kDepth: return vec3(point.view_depth_m);
    default: return textureLod(occlusion_distance, uv, 0.0).rrr;
  }
}

vec3 background(vec2 position_px) { return vec3(0.0); }
#else
vec3 surface_value(ivec2 pixel, GBufferPoint point, vec2 uv) {
  const vec3 direct = direct_light(pixel, point) * (view == kIndirect ? 0.0 : 1.0);
  return direct + indirect_light(point, uv) * (view == kDirect ? 0.0 : 1.0);
}

vec3 background(vec2 position_px) {
  return view == kIndirect ? vec3(0.0) : background_radiance(normalize(camera_ray_ws(position_px)));
}
#endif

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const GBufferPoint point = g_buffer_point(pixel);
  const bool unlit = texelFetch(g_emission, pixel, 0).a > 0.5;
  // Unlit surfaces show their colour as it is, whatever the exposure: marked by a negative share.
  picture = point.valid ? vec4(surface_value(pixel, point, gl_FragCoord.xy / vec2(camera.size_px.xy)), unlit ? -1.0 : 1.0)
                        : vec4(background(gl_FragCoord.xy), 0.0);
}
