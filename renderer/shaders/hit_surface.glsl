// From a hit record to a shaded surface. Needs ray, scene_data, surface.

struct HitPoint {
  Surface surface;
  vec3 position_ws;
  vec3 geometric_normal_ws;  // unit, turned towards where the ray came from
  uint material;
};

HitPoint hit_point(Ray ray, Hit hit, float footprint_m) {
  const Instance instance = instances[hit.instance];
  const Material material = materials[instance.material];
  const uint first = instance.first_index + 3u * hit.triangle;
  const uvec3 corner = uvec3(indices[first], indices[first + 1u], indices[first + 2u]) + instance.first_vertex;
  const vec3 weight = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);

  const vec3 p0 = vertex_position(corner.x);
  const vec3 edge1 = transform_vector(instance, vertex_position(corner.y) - p0);
  const vec3 edge2 = transform_vector(instance, vertex_position(corner.z) - p0);
  const vec3 area_normal = cross(edge1, edge2);
  const bool mirrored = (instance.flags & kInstanceMirrored) != 0u;
  const vec3 outward = normalize(mirrored ? -area_normal : area_normal);

  Attributes at;
  at.normal_ws = transform_normal(instance, vertex_normal(vertices[corner.x].normal) * weight.x +
                                                vertex_normal(vertices[corner.y].normal) * weight.y +
                                                vertex_normal(vertices[corner.z].normal) * weight.z);
  at.tangent_ws = vec3(0.0);
  at.handedness = 1.0;
  at.uv0 = vec2(0.0);
  at.uv1 = vec2(0.0);
  at.color = vec4(1.0);
  float footprint_uv = 0.0;
#ifdef HAS_TEXTURES
  at.color = vertex_color(vertices[corner.x].color) * weight.x + vertex_color(vertices[corner.y].color) * weight.y +
             vertex_color(vertices[corner.z].color) * weight.z;
  const vec2 uv_x = vertices[corner.x].uv0;
  const vec2 uv_y = vertices[corner.y].uv0;
  const vec2 uv_z = vertices[corner.z].uv0;
  at.uv0 = uv_x * weight.x + uv_y * weight.y + uv_z * weight.z;
  at.uv1 = vertices[corner.x].uv1 * weight.x + vertices[corner.y].uv1 * weight.y + vertices[corner.z].uv1 * weight.z;
  const uint packed_tangent = vertices[corner.x].tangent;
  at.tangent_ws = transform_vector(instance, vertex_normal(packed_tangent));
  at.handedness = vertex_handedness(packed_tangent) * (mirrored ? -1.0 : 1.0);
  const vec2 uv1 = uv_y - uv_x;
  const vec2 uv2 = uv_z - uv_x;
  footprint_uv = footprint_m * sqrt(abs(uv1.x * uv2.y - uv1.y * uv2.x) / max(length(area_normal), 1e-20));
#endif

  HitPoint point;
  point.surface = shade_surface(material, at, footprint_uv);
  point.position_ws = ray.origin_ws + hit.t * ray.direction_ws;
  const bool behind = dot(outward, ray.direction_ws) > 0.0;
  point.geometric_normal_ws = behind ? -outward : outward;
  if (behind) point.surface.normal_ws = -point.surface.normal_ws;
  point.surface.normal_ws = visible_shading_normal(point.surface.normal_ws, -ray.direction_ws);
  point.material = instance.material;
  return point;
}
