// An edge-stopping a-trous step over the indirect map (Dammertz et al. 2010) of nine taps, which also stops where neighbours differ by
// more than their noise explains (Schied et al. 2017): the longer the history, the narrower.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#define FLAT_CAMERA
#include "shaders/camera.glsl"
#include "shaders/map_variance.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D map;     // rgb; a: variance, see map_variance.glsl
layout(binding = UNIT_IMAGE_C) uniform usampler2D guide;  // position, normal and roughness
layout(location = 0) out vec4 filtered;

uniform int stride;  // texels between taps: 1, 2, 4, ...
uniform float luminance_tolerance;  // standard deviations

const float kPlaneTolerance = 0.02;  // distance from the centre's plane, relative to its distance from the eye

// The variance about a texel whose own is known. Its own frames may all have missed light that is rare, and then they
// would call black certain: neighbours that have met it know better.
float variance_about(ivec2 texel, float own, ivec2 size) {
  if (own >= kUnknownVariance) return own;
  float sum = 0.0, count = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const float variance = texelFetch(map, clamp(texel + ivec2(x, y), ivec2(0), size - 1), 0).a;
      const bool known = variance >= 0.0 && variance < kUnknownVariance;
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

struct Center {
  vec3 position_ws;
  vec4 normal_roughness;
  float luminance;
  float plane_scale;
  float luminance_scale;
};

struct Sum {
  vec3 light;
  float variance;
  float weights;
};

void add_tap(inout Sum sum, Center center, ivec2 tap, ivec2 size, float share) {
  const ivec2 inside = clamp(tap, ivec2(0), size - 1);
  const vec4 value = texelFetch(map, inside, 0);
  const uvec4 there = texelFetch(guide, inside, 0);
  const vec4 other = unpack_normal_roughness(there.w);
  const vec3 normal_ws = center.normal_roughness.xyz;
  const float off_plane = abs(dot(uintBitsToFloat(there.xyz) - center.position_ws, normal_ws)) * center.plane_scale;
  float similar_normal = max(dot(normal_ws, other.xyz), 0.0);
  for (int i = 0; i < 5; ++i) similar_normal *= similar_normal;  // to the power of 32
  const float off_light = abs(luminance(value.rgb) - center.luminance) * center.luminance_scale;
  const float similar =
      similar_normal * exp2(-1.44 * (off_plane + off_light) - 12.0 * abs(center.normal_roughness.w - other.w));
  const float weight = share * similar * (inside == tap && value.a >= 0.0 ? 1.0 : 0.0);
  sum.light += weight * value.rgb;
  sum.variance += weight * weight * min(value.a, kUnknownVariance);
  sum.weights += weight;
}

void main() {
  const ivec2 texel = ivec2(gl_FragCoord.xy);
  const ivec2 size = textureSize(map, 0);
  const uvec4 here = texelFetch(guide, texel, 0);
  const vec4 value = texelFetch(map, texel, 0);
  if (value.a < 0.0) {
    filtered = finished(value);
    return;
  }
  const vec3 position_ws = uintBitsToFloat(here.xyz);
  const Center center =
      Center(position_ws, unpack_normal_roughness(here.w), luminance(value.rgb),
             1.0 / (kPlaneTolerance * max(distance(position_ws, camera.eye_ws.xyz), 1e-6)),
             1.0 / (luminance_tolerance * sqrt(variance_about(texel, value.a, size)) + 1e-6));
  Sum sum = Sum(vec3(0.0), 0.0, 0.0);
  // A tent: a third of the taps of the usual B3 spline. Written out, for a software device takes longer over a loop.
  add_tap(sum, center, texel + ivec2(-stride, -stride), size, 0.0625);
  add_tap(sum, center, texel + ivec2(0, -stride), size, 0.125);
  add_tap(sum, center, texel + ivec2(stride, -stride), size, 0.0625);
  add_tap(sum, center, texel + ivec2(-stride, 0), size, 0.125);
  add_tap(sum, center, texel, size, 0.25);
  add_tap(sum, center, texel + ivec2(stride, 0), size, 0.125);
  add_tap(sum, center, texel + ivec2(-stride, stride), size, 0.0625);
  add_tap(sum, center, texel + ivec2(0, stride), size, 0.125);
  add_tap(sum, center, texel + ivec2(stride, stride), size, 0.0625);
  filtered = finished(vec4(sum.light / max(sum.weights, 1e-6),
                           min(sum.variance / max(sum.weights * sum.weights, 1e-12), kUnknownVariance)));
}
