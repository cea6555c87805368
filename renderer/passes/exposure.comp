// Exposure from the median luminance of what is lit, smoothed over frames. One work group looks at a grid of pixels.
layout(local_size_x = 256) in;

#include "passes/bindings.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D picture;
layout(std430, binding = BINDING_EXPOSURE) buffer Exposure {
  float exposure;       // linear scale
  float exposure_ev;    // log2 of it
  uint measured;        // 0 until the first frame
};

uniform ivec2 size_px;
uniform float smoothing;   // share of the way to the new value in this frame; 1 at once

const int kBins = 256;
const float kDarkestEv = -24.0, kBrightestEv = 24.0;
const float kMedianTarget = 0.22;   // where the median lands before the tone curve: a little over middle grey
const int kGrid = 64;               // samples along the longer side, at most

shared uint bins[kBins];

void measure(int step_px) {
  const ivec2 grid = (size_px + step_px - 1) / step_px;
  for (int i = int(gl_LocalInvocationIndex); i < grid.x * grid.y; i += 256) {
    const ivec2 pixel = min(ivec2(i % grid.x, i / grid.x) * step_px + step_px / 2, size_px - 1);
    const vec4 value = texelFetch(picture, pixel, 0);
    const float light = value.a - 1.0;  // of all light, whatever the view shows
    if (!(light > 1e-6)) continue;
    const float position = (log2(light) - kDarkestEv) / (kBrightestEv - kDarkestEv);
    atomicAdd(bins[clamp(int(position * float(kBins)), 0, kBins - 1)], 1u);
  }
}

// The median's log2, interpolated within its bin; 0 samples give none.
bool median_ev(out float ev) {
  uint total = 0u;
  for (int i = 0; i < kBins; ++i) total += bins[i];
  ev = 0.0;
  if (total == 0u) return false;
  float before = 0.0;
  for (int i = 0; i < kBins; ++i) {
    const float count = float(bins[i]);
    if (before + count >= 0.5 * float(total)) {
      const float within = (0.5 * float(total) - before) / max(count, 1.0);
      ev = kDarkestEv + (float(i) + within) * (kBrightestEv - kDarkestEv) / float(kBins);
      return true;
    }
    before += count;
  }
  return true;
}

void main() {
  bins[gl_LocalInvocationIndex] = 0u;
  barrier();
  measure(max(1, max(size_px.x, size_px.y) / kGrid));
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  float ev;
  const bool found = median_ev(ev);
  const float target = found ? log2(kMedianTarget) - ev : 0.0;
  exposure_ev = measured == 0u ? target : mix(exposure_ev, target, found ? smoothing : 0.0);
  exposure = exp2(exposure_ev);
  if (found) measured = 1u;
}
