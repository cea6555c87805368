// The picture averaged with those before it, which looked through other points of the pixels (temporal anti-aliasing). What
// was seen before is found again by the motion of camera and surfaces, and counts as far as it lies between the colours
// that are around it now (Lottes 2011; Karis 2014, without weights by luminance: light stays as much as it is).
// REFINE: nothing has changed, and the mean of all frames is wanted.
#include "passes/bindings.glsl"
#define FLAT_CAMERA
#include "shaders/camera.glsl"
#include "shaders/finite.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D current;        // of this frame
layout(binding = UNIT_IMAGE_B) uniform sampler2D before;         // what this pass made a frame ago
layout(binding = UNIT_IMAGE_C) uniform sampler2D frames_before;  // how many are in it
layout(binding = UNIT_G_DEPTH) uniform sampler2D g_depth;
#ifdef MOTION
layout(binding = UNIT_G_MOTION) uniform sampler2D g_motion;  // metres since the frame before
#endif

layout(location = 0) out vec4 picture;  // a: of this frame
layout(location = 1) out float frames;  // in the mean; over kCountScale

uniform float most_frames;              // that the pictures before count for
uniform mat4 previous_clip_from_world;  // with this frame's shift of the picture

const float kCountScale = 255.0;
const float kForgetting = 4.0;

#ifndef REFINE
const ivec2 kCross[5] = ivec2[](ivec2(0, 0), ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

// A pixel at an edge goes with what is nearest around it, so that the edge's smooth pixels go with the surface.
ivec2 nearest_around(ivec2 pixel, ivec2 size, out float depth) {
  ivec2 nearest = pixel;
  depth = -1.0;
  for (int i = 0; i < 5; ++i) {
    const ivec2 tap = clamp(pixel + kCross[i], ivec2(0), size - 1);
    const float there = texelFetch(g_depth, tap, 0).r;
    if (there > depth) nearest = tap;
    depth = max(depth, there);
  }
  return nearest;
}

vec2 pixel_before(vec4 place, vec2 size) {
  const vec4 clip = previous_clip_from_world * place;
  return clip.w > 0.0 ? (clip.xy / clip.w * 0.5 + 0.5) * size : vec2(-1e6);
}

// How far the picture has moved here since the frame before, in pixels; `own_px`: not by the camera's motion alone.
vec2 motion_px(ivec2 pixel, vec2 size, out float own_px) {
  float depth;
  const ivec2 nearest = nearest_around(pixel, ivec2(size), depth);
  const vec2 center = vec2(nearest) + 0.5;
  vec4 place = vec4(camera_ray_ws(center), 0.0);  // of the background, far away
  if (depth > 0.0) place = vec4(position_from_depth(center, depth), 1.0);
  vec2 before_px = pixel_before(place, size);
  own_px = 0.0;
#ifdef MOTION
  const vec2 standing_px = before_px;
  if (depth > 0.0) place.xyz -= texelFetch(g_motion, nearest, 0).xyz;
  before_px = pixel_before(place, size);
  own_px = distance(before_px, standing_px);
#endif
  return center - before_px;
}

// Catmull and Rom's filter in five bilinear taps, without the corners (Jimenez 2016): a picture that is resampled in every
// frame stays sharp.
vec3 sharp_before(vec2 position_px, vec2 size) {
  const vec2 center = floor(position_px - 0.5) + 0.5, f = position_px - center;
  const vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f)), w3 = f * f * (-0.5 + 0.5 * f);
  const vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f), w12 = 1.0 - w0 - w3;
  const vec2 p12 = (center + (w12 - w1) / w12) / size;
  const vec2 p0 = (center - 1.0) / size, p3 = (center + 2.0) / size;
  const float weights[5] = float[](w12.x * w0.y, w0.x * w12.y, w12.x * w12.y, w3.x * w12.y, w12.x * w3.y);
  vec3 sum = weights[0] * textureLod(before, vec2(p12.x, p0.y), 0.0).rgb;
  sum += weights[1] * textureLod(before, vec2(p0.x, p12.y), 0.0).rgb;
  sum += weights[2] * textureLod(before, p12, 0.0).rgb;
  sum += weights[3] * textureLod(before, vec2(p3.x, p12.y), 0.0).rgb;
  sum += weights[4] * textureLod(before, vec2(p12.x, p3.y), 0.0).rgb;
  return sum / (weights[0] + weights[1] + weights[2] + weights[3] + weights[4]);
}

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy), size = camera.size_px.xy;
  const vec4 here = texelFetch(current, pixel, 0);
  vec3 least = here.rgb, most = here.rgb;
  for (int i = 1; i < 5; ++i) {
    const vec3 there = texelFetch(current, clamp(pixel + kCross[i], ivec2(0), size - 1), 0).rgb;
    least = min(least, there);
    most = max(most, there);
  }
  float own_px;
  const vec2 position_before_px = gl_FragCoord.xy - motion_px(pixel, vec2(size), own_px);
  const bool was_seen = all(greaterThan(position_before_px, vec2(0.0))) && all(lessThan(position_before_px, vec2(size)));
  const vec2 safe_px = was_seen ? position_before_px : vec2(0.5);
  float known = min(texelFetch(frames_before, ivec2(safe_px), 0).r * kCountScale, was_seen ? most_frames / (1.0 + own_px) : 0.0);
  const vec3 found = max(sharp_before(safe_px, vec2(size)), 0.0);
  const vec3 history = clamp(found, least, most);
  // What had to be changed much was of something else: a shadow that has moved on, a surface that was hidden.
  const vec3 off = abs(found - history) / max(max(found, history), vec3(1e-20));
  known /= 1.0 + kForgetting * max(off.r, max(off.g, off.b));
  picture = finite_light(vec4(mix(history, here.rgb, 1.0 / (known + 1.0)), here.a));
  frames = (known + 1.0) / kCountScale;
}
#else
void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const vec4 here = texelFetch(current, pixel, 0);
  picture = here;
  if (most_frames > 0.0) picture.rgb = mix(texelFetch(before, pixel, 0).rgb, here.rgb, 1.0 / (most_frames + 1.0));
  frames = min(most_frames + 1.0, kCountScale) / kCountScale;
}
#endif
