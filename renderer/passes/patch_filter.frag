// An edge-stopping a-trous step over the indirect map (Dammertz et al. 2010) of nine taps, which also stops where neighbours differ by
// more than their noise explains (Schied et al. 2017): the longer the history, the narrower.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#define FLAT_CAMERA
#include "shaders/camera.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D map;      // rgb; a: variance of its luminance, negative: nothing there
layout(binding = UNIT_IMAGE_B) uniform sampler2D moments;  // FIRST: of luminance, to get the variance of; a: frames
layout(binding = UNIT_IMAGE_C) uniform usampler2D guide;   // position, normal and roughness
layout(location = 0) out vec4 filtered;

uniform int stride;  // texels between taps: 1, 2, 4, ...
uniform float luminance_tolerance;  // standard deviations

const float kPlaneTolerance = 0.02;  // distance from the centre's plane, relative to its distance from the eye
const float kFewFrames = 4.0;        // fewer say nothing of the variance
const float kUnknown = 1e30;

#ifdef FIRST
// The variance of the mean of all frames; negative where nothing is seen.
float variance_at(ivec2 texel) {
  const vec4 moment = texelFetch(moments, texel, 0);
  const float variance = max(moment.y - moment.x * moment.x, 0.0) / max(moment.w - 1.0, 1.0);
  return moment.w <= 0.0 ? -1.0 : moment.w < kFewFrames ? kUnknown : variance;
}
vec4 value_at(ivec2 texel) { return vec4(texelFetch(map, texel, 0).rgb, variance_at(texel)); }
#else
float variance_at(ivec2 texel) { return texelFetch(map, texel, 0).a; }
vec4 value_at(ivec2 texel) { return texelFetch(map, texel, 0); }
#endif

// The variance about a texel whose own is known. Its own frames may all have missed light that is rare, and then they
// would call black certain: neighbours that have met it know better.
float variance_about(ivec2 texel, float own, ivec2 size) {
  if (own >= kUnknown) return own;
  float sum = 0.0, count = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const float variance = variance_at(clamp(texel + ivec2(x, y), ivec2(0), size - 1));
      const bool known = variance >= 0.0 && variance < kUnknown;
      sum += known ? variance : 0.0;
      count += known ? 1.0 : 0.0;
    }
  return max(own, sum / max(count, 1.0));
}

#ifdef LAST
// Premultiplied by validity, for scaling up.
vec4 finished(vec4 value) { return value.a < 0.0 ? vec4(0.0) : vec4(value.rgb, 1.0); }
#else
vec4 finished(vec4 value) { return value; }
#endif

void main() {
  const ivec2 texel = ivec2(gl_FragCoord.xy);
  const ivec2 size = textureSize(map, 0);
  const uvec4 here = texelFetch(guide, texel, 0);
  const vec4 center = value_at(texel);
  if (center.a < 0.0) {
    filtered = finished(center);
    return;
  }
  const vec3 position_ws = uintBitsToFloat(here.xyz);
  const vec4 normal_roughness = unpack_normal_roughness(here.w);
  const float plane_scale = 1.0 / (kPlaneTolerance * max(distance(position_ws, camera.eye_ws.xyz), 1e-6));
  const float center_luminance = luminance(center.rgb);
  const float luminance_scale = 1.0 / (luminance_tolerance * sqrt(variance_about(texel, center.a, size)) + 1e-6);
  const float kernel[2] = float[](0.5, 0.25);  // a tent: a third of the taps of the usual B3 spline
  vec3 sum = vec3(0.0);
  float variance = 0.0, weights = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const ivec2 tap = texel + ivec2(x, y) * stride;
      const ivec2 inside = clamp(tap, ivec2(0), size - 1);
      const vec4 value = value_at(inside);
      const uvec4 there = texelFetch(guide, inside, 0);
      const vec4 other = unpack_normal_roughness(there.w);
      const float off_plane = abs(dot(uintBitsToFloat(there.xyz) - position_ws, normal_roughness.xyz)) * plane_scale;
      float similar_normal = max(dot(normal_roughness.xyz, other.xyz), 0.0);
      for (int i = 0; i < 5; ++i) similar_normal *= similar_normal;  // to the power of 32
      const float off_light = abs(luminance(value.rgb) - center_luminance) * luminance_scale;
      const float similar =
          similar_normal * exp2(-1.44 * (off_plane + off_light) - 12.0 * abs(normal_roughness.w - other.w));
      const float weight = kernel[abs(x)] * kernel[abs(y)] * similar * (inside == tap && value.a >= 0.0 ? 1.0 : 0.0);
      sum += weight * value.rgb;
      variance += weight * weight * min(value.a, kUnknown);
      weights += weight;
    }
  filtered = finished(vec4(sum / max(weights, 1e-6), min(variance / max(weights * weights, 1e-12), kUnknown)));
}
