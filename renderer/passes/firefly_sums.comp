// Adds up the parts of passes/firefly_clamp.comp, over the frames as the history of the picture does: what earlier frames have
// brought counts for kept_frames at most. MEASURE: what samples bring in the mean; begins a frame.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/group_sum.glsl"

layout(std430, binding = BINDING_FIREFLY_PARTS) readonly buffer Parts { vec2 parts[]; };
layout(std430, binding = BINDING_FIREFLY_SUMS) buffer Totals {
  float mean;     // luminance over albedo, nit
  float frames;   // in all of these
  float fresh;    // the share of this frame
  float removed;  // luminance times pixels
  float brought;
};

uniform uint part_count;
uniform float kept_frames;

void main() {
  vec2 own = vec2(0.0);
  for (uint part = gl_LocalInvocationIndex; part < part_count; part += 64u) own += parts[part];
  const vec2 now = group_sum(own);
  if (gl_LocalInvocationIndex != 0u) return;
#ifdef MEASURE
  const float before = min(frames, kept_frames);
  fresh = 1.0 / (before + 1.0);
  mean = mix(mean, now.y > 0.0 ? now.x / now.y : mean, fresh);
  frames = before + 1.0;
  removed *= 1.0 - fresh;
  brought *= 1.0 - fresh;
#else
  removed += fresh * now.x;
  brought += fresh * now.y;
#endif
}
