// How far a point of an instance has come since the frame before: MOTION; DEFORMED_MOTION: within its mesh as well.
// Needs scene_data.

const uint kAsItWas = 0xffffffffu;  // DeviceInstanceBefore::first_position

// By the difference of the matrices, so that what stands still is found to stand still to the last bit. `within`: in
// object space.
vec3 displacement(Instance instance, vec4 before[3], vec3 position, vec3 within) {
  vec3 moved;
  for (int i = 0; i < 3; ++i) moved[i] = dot(instance.world_from_object[i] - before[i], vec4(position, 1.0));
#ifdef DEFORMED_MOTION
  for (int i = 0; i < 3; ++i) moved[i] += dot(before[i].xyz, within);
#endif
  return moved;
}

#ifdef DEFORMED_MOTION
layout(binding = UNIT_POSITIONS_BEFORE) uniform samplerBuffer positions_before;

// `vertex` counts from the instance's first.
vec3 moved_within_mesh(uint first_position_before, uint vertex, vec3 position) {
  if (first_position_before == kAsItWas) return vec3(0.0);
  return position - texelFetch(positions_before, int(first_position_before + vertex)).xyz;
}
#endif
