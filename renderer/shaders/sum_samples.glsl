// The light of a texel's samples. Needs bindings, patch_samples.

layout(binding = UNIT_SAMPLE_STATES) uniform samplerBuffer states;       // weight of a ray; density
layout(binding = UNIT_SAMPLE_LIGHT) uniform samplerBuffer light;         // two a slot: known, waiting; then of the lamps
layout(binding = UNIT_SAMPLE_VISIBLE) uniform usamplerBuffer visible;    // a bit a shadow ray
#ifndef PIXEL_LIST
layout(binding = UNIT_NEXT_STATES) uniform samplerBuffer next_states;    // two a path that went on; first: reflectance
layout(binding = UNIT_NEXT_LIGHT) uniform samplerBuffer next_light;      // two a path that went on; first: what came
#endif

uniform uint sample_count;
uniform int lamps_sampled;           // 1: behind the rays' light is that of the lamps
#ifndef PIXEL_LIST
uniform uint path_stride;
uniform uint path_phase;
uniform uint first_next;             // the place of the first path that went on
#endif

bool is_visible(uint slot) { return (texelFetch(visible, int(slot / 32u)).x >> (slot & 31u) & 1u) != 0u; }

vec3 arriving_along_ray(uint slot) {
  const vec4 known = texelFetch(light, int(2u * slot));
  const vec4 waiting = texelFetch(light, int(2u * slot + 1u));
  vec3 arriving = known.rgb + (is_visible(slot) ? waiting.rgb : vec3(0.0));
#ifndef PIXEL_LIST
  if (waiting.a > 0.5 && slot % path_stride == path_phase) {
    const int next = int(2u * (first_next + slot / path_stride));
    arriving += texelFetch(next_states, next).rgb * texelFetch(next_light, next).rgb;
  }
#endif
  return arriving;
}

vec3 light_of_ray(uint slot) { return arriving_along_ray(slot) * texelFetch(states, int(slot)).rgb; }

vec3 light_of_lamp(uint texel_index) {
  const bool lit = lamps_sampled == 1 && is_visible(sample_count + texel_index);
  return lit ? texelFetch(light, int(2u * sample_count + texel_index)).rgb : vec3(0.0);
}

vec3 light_of_samples(uint texel_index) {
  const uint texels = traced_texels();
  vec3 sum = vec3(0.0);
  for (uint ray = 0u; ray < rays_per_texel; ++ray) sum += light_of_ray(ray * texels + texel_index);
  return sum / float(rays_per_texel) + light_of_lamp(texel_index);
}
