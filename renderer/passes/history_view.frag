// What `realtime` knows about a pixel besides its light: the view of that name. Values from 0 to 1.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#define FLAT_CAMERA
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/radiance_cache.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D unfiltered_map;  // a: frames in it
layout(binding = UNIT_IMAGE_B) uniform sampler2D moments;         // of luminance: first, second; of late frames
layout(binding = UNIT_IMAGE_C) uniform usampler2D guide;          // position, normal and roughness
#ifdef MOTION
layout(binding = UNIT_G_MOTION) uniform sampler2D g_motion;  // metres since the frame before
#endif

layout(location = 0) out vec4 shown;

uniform int view;                       // VIEW_HISTORY, ...
uniform mat4 previous_clip_from_world;  // with this frame's shift of the picture

const float kLongHistory = 64.0;   // frames
const float kFarMotion_px = 16.0;

ivec2 texel_of(ivec2 pixel) {
  const ivec2 size = textureSize(unfiltered_map, 0);
  return min(ivec2((vec2(pixel) + 0.5) * vec2(size) / vec2(camera.size_px.xy)), size - 1);
}

// Standard deviation of the frames' light over its mean.
float relative_deviation(ivec2 texel) {
  const vec2 moment = texelFetch(moments, texel, 0).xy;
  return sqrt(max(moment.y - moment.x * moment.x, 0.0)) / max(moment.x, 1e-20);
}

// By how much late frames differ from all.
float gradient(ivec2 texel) {
  const vec4 moment = texelFetch(moments, texel, 0);
  return abs(moment.z - moment.x) / max(max(moment.z, moment.x), 1e-20);
}

// 0.5: at rest; to the right, downwards more.
vec2 motion(ivec2 pixel, GBufferPoint point) {
  vec3 before_ws = point.position_ws;
#ifdef MOTION
  before_ws -= texelFetch(g_motion, pixel, 0).xyz;
#endif
  const vec4 clip = previous_clip_from_world * vec4(before_ws, 1.0);
  if (clip.w <= 0.0) return vec2(1.0);
  const vec2 way_px = vec2(pixel) + 0.5 - (clip.xy / clip.w * 0.5 + 0.5) * vec2(camera.size_px.xy);
  return 0.5 + 0.5 * clamp(way_px / kFarMotion_px, -1.0, 1.0);
}

// None of the four texels around is of the pixel's surface: their light is that of another.
bool is_unmatched(ivec2 pixel, GBufferPoint point) {
  const ivec2 size = textureSize(unfiltered_map, 0);
  const vec2 position = (vec2(pixel) + 0.5) * vec2(size) / vec2(camera.size_px.xy) - 0.5;
  const float plane_scale = 1.0 / (0.01 * point.view_depth_m);
  bool matched = false;
  for (int i = 0; i < 4; ++i) {
    const ivec2 texel = clamp(ivec2(floor(position)) + ivec2(i & 1, i >> 1), ivec2(0), size - 1);
    const uvec4 there = texelFetch(guide, texel, 0);
    const float off_plane = abs(dot(uintBitsToFloat(there.xyz) - point.position_ws, point.normal_ws)) * plane_scale;
    matched = matched || (off_plane < 1.0 && dot(unpack_normal_roughness(there.w).xyz, point.normal_ws) > 0.7);
  }
  return !matched;
}

// A colour for each cell of the radiance cache, dark where nothing is known yet.
vec3 cell_color(GBufferPoint point) {
  const uint cell = find_cell(cell_place(point.position_ws, point.geometric_normal_ws, 1e30, false, vec2(0.5)));
  const uint bits = hash(cell + 1u);
  const vec3 color = 0.2 + 0.7 * vec3(bits & 0xffu, bits >> 8 & 0xffu, bits >> 16 & 0xffu) / 255.0;
  return cell == kNoCell ? vec3(0.0) : color;
}

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy), texel = texel_of(pixel);
  const GBufferPoint point = g_buffer_point(pixel);
  vec3 value = vec3(0.0);
  switch (view) {
    case VIEW_HISTORY: value = vec3(min(texelFetch(unfiltered_map, texel, 0).a / kLongHistory, 1.0)); break;
    case VIEW_VARIANCE: value = vec3(min(relative_deviation(texel), 1.0)); break;
    case VIEW_GRADIENT: value = vec3(gradient(texel)); break;
    case VIEW_MOTION: value = vec3(motion(pixel, point), 0.5); break;
    case VIEW_CACHE_CELLS: value = cell_color(point); break;
    default: value = vec3(is_unmatched(pixel, point) ? 1.0 : 0.0);
  }
  shown = vec4(point.valid ? value : vec3(0.0), 1.0);
}
