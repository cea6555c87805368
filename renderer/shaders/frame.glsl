// What directions are measured by. Compiles for lanes as well.
#include "shaders/select.glsl"

const float kPi = 3.14159265358979;

// An orthonormal frame whose third column is `normal`: Duff et al. 2017, "Building an orthonormal basis, revisited".
mat3 frame_around(vec3 normal) {
  const float s = select(normal.z >= 0.0, 1.0, -1.0);
  const float a = -1.0 / (s + normal.z);
  const float b = normal.x * normal.y * a;
  return mat3(vec3(1.0 + s * normal.x * normal.x * a, s * b, -s * normal.x),
              vec3(b, s + normal.y * normal.y * a, -normal.y), normal);
}
