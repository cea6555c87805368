// What is written to pictures: always numbers.

// No light of a scene comes near it: what is greater, infinite or not a number is an overflow of extreme values given.
const float kGreatestRadiance = 1e36;

// For views that are of something with a sign.
vec4 finite_value(vec4 value) {
  return mix(vec4(0.0), clamp(value, vec4(-kGreatestRadiance), vec4(kGreatestRadiance)), equal(value, value));
}

// Alpha may be -1, see Picture; colours are never negative.
vec4 finite_light(vec4 light) {
  return mix(vec4(0.0), clamp(light, vec4(0.0, 0.0, 0.0, -1.0), vec4(kGreatestRadiance)), equal(light, light));
}
