// Ray against triangle by the signs of the three edges' volumes (Pluecker), as Embree's robust mode does it: an edge gives
// the same volume, up to its sign, to both triangles that share it, so that no ray passes between them.
// `precise` keeps the compiler from contracting one triangle's products otherwise than its neighbour's.

float edge_volume(vec3 edge, vec3 sum, vec3 direction) {
  precise vec3 normal = vec3(edge.y * sum.z - edge.z * sum.y, edge.z * sum.x - edge.x * sum.z,
                             edge.x * sum.y - edge.y * sum.x);
  precise float volume = normal.x * direction.x + normal.y * direction.y + normal.z * direction.z;
  return volume;
}

// True if the ray meets the triangle strictly between t_min and t_max. `uv` are the weights of b and c.
bool hits_triangle(vec3 origin, vec3 direction, float t_min, float t_max, vec3 a, vec3 b, vec3 c, out float t,
                   out vec2 uv) {
  a -= origin;
  b -= origin;
  c -= origin;
  const float volume_b = edge_volume(c - a, c + a, direction);
  const float volume_c = edge_volume(a - b, a + b, direction);
  const float volume_a = edge_volume(b - c, b + c, direction);
  const float sum = volume_a + volume_b + volume_c;
  const float tolerance = abs(sum) * 1.1920929e-7;
  if (min(volume_a, min(volume_b, volume_c)) < -tolerance && max(volume_a, max(volume_b, volume_c)) > tolerance)
    return false;
  const vec3 normal = cross(c - a, a - b);
  const float cosine = dot(normal, direction);
  if (cosine == 0.0 || sum == 0.0) return false;
  t = dot(a, normal) / cosine;
  uv = clamp(vec2(volume_b, volume_c) / sum, 0.0, 1.0);
  return t > t_min && t < t_max;
}
