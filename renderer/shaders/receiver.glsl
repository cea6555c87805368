// Where light is gathered. Needs brdf; compiles for lanes as well, see shaders/select.glsl.

// A surface ready to weight directions.
struct Receiver {
  Brdf brdf;
  mat3 frame;
  vec3 out_direction;  // in the frame
  vec3 geometric_normal_ws;
};

// f cos(theta) / pdf. Light that passes the surface comes from below both normals, what is reflected from above both.
vec3 weight_of(Receiver receiver, vec3 direction_ws, float pdf) {
  const vec3 in_direction = direction_ws * receiver.frame;
  const bool agree = (dot(direction_ws, receiver.geometric_normal_ws) < 0.0) == (in_direction.z < 0.0);
  const vec3 value = brdf_times_cosine(receiver.brdf, receiver.out_direction, in_direction);
  return select(pdf > 0.0 && agree, value / max(pdf, 1e-20), vec3(0.0));
}
