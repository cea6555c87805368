// The seam's records; the C++ side is renderer/tracing/tracer.h.

struct Ray {
  vec3 origin_ws;
  float t_min;
  vec3 direction_ws;  // unit
  float t_max;        // below t_min: inactive
};

// Scalars only, so that the std430 stride is 20 bytes.
struct Hit {
  float t;  // metres; negative: a miss
  uint instance;
  uint triangle;
  float u;
  float v;
};
