// The surfaces of the scene-referred picture: emission and direct light through the variance shadow maps (thesis 4.1), and the indirect
// map scaled up bilinearly (thesis 5.3) and multiplied with the directional albedo it was divided by; or one of the
// views. NO_MAP: all pixels get rays of their own. Blending averages with earlier frames; the depth test leaves the background to background.frag.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#define FLAT_CAMERA
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#ifndef TRACED_LIGHT
#include "shaders/lights.glsl"
#endif
#include "shaders/finite.glsl"
#include "shaders/smooth_lobe.glsl"
#include "shaders/upscaled_map.glsl"

// a: 1 + luminance of all light on lit surfaces, so that every view is exposed alike; -1 on unlit surfaces.
layout(location = 0) out vec4 picture;
layout(binding = UNIT_IMAGE_C) uniform sampler2D occlusion_distance;

#ifdef AUXILIARY_VIEWS
layout(binding = UNIT_VIEW_MAP) uniform sampler2D view_map;  // see map_view.comp
#endif

uniform int view;  // VIEW_FINAL, ...

#ifdef TRACED_LIGHT
// By so many shadow rays a pixel: see punctual_light.comp.
layout(binding = UNIT_PUNCTUAL_LIGHT) uniform samplerBuffer punctual_light;
layout(binding = UNIT_PUNCTUAL_VISIBLE) uniform usamplerBuffer punctual_visible;  // a bit a ray

vec3 direct_light(ivec2 pixel, GBufferPoint point) {
  vec3 light = texelFetch(g_emission, pixel, 0).rgb;
  for (int i = 0; i < TRACED_LIGHT; ++i) {
    const int ray = (i * camera.size_px.y + pixel.y) * camera.size_px.x + pixel.x;
    const bool visible = (texelFetch(punctual_visible, ray / 32).x >> (ray & 31) & 1u) != 0u;
    light += visible ? texelFetch(punctual_light, ray).rgb : vec3(0.0);
  }
  return light;
}
#else
vec3 direct_light(ivec2 pixel, GBufferPoint point) {
  return texelFetch(g_emission, pixel, 0).rgb +
         reflected_punctual_light(point.brdf, point.position_ws, point.normal_ws, point.to_camera_ws);
}
#endif

#ifdef OVER_BEHIND
layout(binding = UNIT_BEHIND) uniform sampler2D behind;              // the picture without clear surfaces
layout(binding = UNIT_CLEAR_LAYERS) uniform sampler2D clear_layers;  // see clear_layers.frag

vec4 over_behind(ivec2 pixel, GBufferPoint point, vec4 own) {
  vec3 passed = exp(-max(texelFetch(clear_layers, pixel, 0).rgb, 0.0));
#ifdef REFRACTED
  if (point.brdf.eta != 1.0) passed = vec3(0.0);  // a ray of the pixel's own finds it
#endif
  const vec4 there = texelFetch(behind, pixel, 0);
  return own + vec4(passed * there.rgb, luminance(passed) * max(there.a - 1.0, 0.0));
}
#else
vec4 over_behind(ivec2 pixel, GBufferPoint point, vec4 own) { return own; }
#endif

#ifdef LIST_PIXELS
// Pixels that get rays of their own after this pass: see passes/pixel_samples.h.
layout(early_fragment_tests) in;
layout(std430, binding = BINDING_PIXEL_COUNTS) buffer PixelCounts { uint reflecting_count, unmatched_count, listed_count; };
layout(std430, binding = BINDING_REFLECTING_PIXELS) writeonly buffer ReflectingPixels { uint reflecting_pixels[]; };
layout(std430, binding = BINDING_UNMATCHED_PIXELS) writeonly buffer UnmatchedPixels { uint unmatched_pixels[]; };
uniform float unmatched_share;  // of the unmatched pixels, so many are listed, of which there is room for most_unmatched
uniform uint most_unmatched;
uniform uint frame_number;

void list_pixel(ivec2 pixel, GBufferPoint point, bool matched) {
  const uint word = uint(pixel.y << 16 | pixel.x);
#ifdef NO_MAP
  reflecting_pixels[atomicAdd(reflecting_count, 1u)] = word;
#elif defined(SMOOTH_SURFACES)
  if (is_smooth(point.brdf)) reflecting_pixels[atomicAdd(reflecting_count, 1u)] = word;
#endif
  if (matched) return;
  atomicAdd(unmatched_count, 1u);
  if (unit_interval(hash(word ^ hash(frame_number))) >= unmatched_share) return;
  const uint place = atomicAdd(listed_count, 1u);
  if (place < most_unmatched) unmatched_pixels[place] = word;
}
#else
void list_pixel(ivec2 pixel, GBufferPoint point, bool matched) {}
#endif

#ifdef NO_MAP
vec3 indirect_light(ivec2 pixel, GBufferPoint point, vec2 uv) {
  list_pixel(pixel, point, true);
  return vec3(0.0);
}
#else
vec3 indirect_light(ivec2 pixel, GBufferPoint point, vec2 uv) {
  const MapSample map = upscaled_map(point, uv);
  list_pixel(pixel, point, map.matched);
  point.brdf = brdf_of_map(point.brdf);
  return modulated(point, map.light);
}
#endif

#ifdef AUXILIARY_VIEWS
vec4 surface_value(ivec2 pixel, GBufferPoint point, vec2 uv) {
  vec3 value = vec3(0.0);
  switch (view) {
    case VIEW_ALBEDO: value = point.brdf.diffuse_albedo + point.brdf.f0; break;
    case VIEW_NORMAL: value = point.normal_ws * 0.5 + 0.5; break;
    case VIEW_DEPTH: value = vec3(point.view_depth_m); break;
    case VIEW_POSITION: value = point.position_ws; break;
    case VIEW_NORMAL_DEPTH: value = vec3(point.normal_ws.xy * 0.5 + 0.5, 1.0 / (1.0 + 0.1 * point.view_depth_m)); break;
    case VIEW_OCCLUSION_DISTANCE: value = textureLod(occlusion_distance, uv, 0.0).rrr; break;
    default: value = texelFetch(view_map, ivec2(uv * vec2(textureSize(view_map, 0))), 0).rgb;
  }
  return vec4(value, 1.0 + luminance(value));
}
#else
vec4 surface_value(ivec2 pixel, GBufferPoint point, vec2 uv) {
  const vec3 direct = direct_light(pixel, point);
  const vec3 indirect = indirect_light(pixel, point, uv);
  const vec3 shown = direct * (view == VIEW_FINAL || view == VIEW_DIRECT ? 1.0 : 0.0) +
                     indirect * (view == VIEW_DIRECT ? 0.0 : 1.0);
  return over_behind(pixel, point, vec4(shown, 1.0 + luminance(direct + indirect)));
}
#endif

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const GBufferPoint point = g_buffer_point(pixel);
  // Unlit surfaces show their colour as it is, whatever the exposure.
  const bool unlit = texelFetch(g_emission, pixel, 0).a > 0.5;
  const vec4 surface = surface_value(pixel, point, gl_FragCoord.xy / vec2(camera.size_px.xy));
  const vec4 value = vec4(surface.rgb, unlit ? -1.0 : surface.a);
#ifdef AUXILIARY_VIEWS
  picture = finite_value(value);
#else
  picture = finite_light(value);
#endif
}
