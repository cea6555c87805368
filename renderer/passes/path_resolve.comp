// Adds the light whose shadow ray got through, and counts the paths that go on, chunk by chunk.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/path.glsl"

layout(binding = UNIT_PATH_PENDING) uniform usamplerBuffer pending;
layout(binding = UNIT_PATH_VISIBLE) uniform usamplerBuffer visible;  // a bit a slot
layout(binding = UNIT_PATH_PIXELS) uniform usamplerBuffer paths;
layout(std430, binding = BINDING_PATH_RADIANCE) buffer Radiance { vec4 radiance[]; };
layout(std430, binding = BINDING_PATH_COUNTS) writeonly buffer Counts { uint counts[]; };  // the sum first

uniform uint path_count;

void main() {
  const uint chunk = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint first = chunk * uint(PATH_CHUNK);
  if (first >= path_count) return;
  uint alive = 0u;
  for (uint slot = first; slot < min(first + uint(PATH_CHUNK), path_count); ++slot) {
    alive += texelFetch(paths, int(slot)).x != kDeadPath ? 1u : 0u;
    const uvec4 light = texelFetch(pending, int(slot));
    const bool seen = (texelFetch(visible, int(slot / 32u)).x >> (slot & 31u) & 1u) != 0u;
    if (light.w != kDeadPath && seen)
      radiance[pending_pixel(light.w)] += shown_light(uintBitsToFloat(light.xyz), (light.w & kDirectLight) != 0u);
  }
  counts[1u + chunk] = alive;
}
