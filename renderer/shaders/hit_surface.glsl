// From a hit record to a shaded surface. Needs ray, scene_data, surface.

struct HitPoint {
  Surface surface;
  Brdf brdf;
  vec3 position_ws;
  vec3 geometric_normal_ws;  // unit, turned towards where the ray came from
  uint material_flags;
  bool from_behind;          // the ray came from the back of the triangle, by its winding
  vec3 medium_transmittance;  // of the volume that the ray passed to come here, by Beer's law; 1 outside volumes
};

#ifdef HAS_LOBES
#include "shaders/lobes.glsl"

// Light that reaches the back of a volume's surface was inside it.
void add_lobes(inout HitPoint point, Lobes lobes, Ray ray, float distance_m, bool behind) {
  const bool inside = behind && lobes.ior > 0.0;
  const float eta = lobes.ior > 0.0 ? (inside ? 1.0 / lobes.ior : lobes.ior) : 1.0;
  const vec3 to_viewer = -ray.direction_ws;
  if (behind) lobes.clearcoat_normal_ws = -lobes.clearcoat_normal_ws;
  lobes.clearcoat_normal_ws =
      visible_shading_normal(lobes.clearcoat_normal_ws, point.geometric_normal_ws, to_viewer);
  if (inside) {
    lobes.clearcoat = 0.0;
    lobes.sheen_color = vec3(0.0);
    point.medium_transmittance = exp(-lobes.absorption * distance_m);
  }
  point.brdf = with_lobes(point.brdf, clamp(point.surface.base_color.rgb, 0.0, 1.0),
                          clamp(point.surface.metallic, 0.0, 1.0), lobes, eta);
  point.surface.emission *= 1.0 - clearcoat_reflectance(point.brdf, dot(lobes.clearcoat_normal_ws, to_viewer));
}
#endif

HitPoint hit_point(Ray ray, Hit hit, float footprint_m) {
  const Instance instance = fetch_instance(hit.instance);
  const Material material = fetch_material(instance.material);
  const vec3 weight = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
  const uvec4 normals = triangle_normals(instance, hit.triangle);
  const vec3 outward = transform_normal(instance, vertex_normal(normals.w));

  Attributes at;
  at.normal_ws = transform_normal(instance, vertex_normal(normals.x) * weight.x + vertex_normal(normals.y) * weight.y +
                                                vertex_normal(normals.z) * weight.z);
  at.tangent_ws = vec3(0.0);
  at.handedness = 1.0;
  at.uv0 = vec2(0.0);
  at.uv1 = vec2(0.0);
  at.color = vec4(1.0);
  float footprint_uv = 0.0;
#ifdef HAS_TEXTURES
  const uvec4 corners = triangle_corners(instance, hit.triangle);
  const Vertex a = fetch_vertex(corners.x);
  const Vertex b = fetch_vertex(corners.y);
  const Vertex c = fetch_vertex(corners.z);
  at.color = vertex_color(a.color) * weight.x + vertex_color(b.color) * weight.y + vertex_color(c.color) * weight.z;
  at.uv0 = a.uv0 * weight.x + b.uv0 * weight.y + c.uv0 * weight.z;
  at.uv1 = a.uv1 * weight.x + b.uv1 * weight.y + c.uv1 * weight.z;
  at.tangent_ws = transform_vector(instance, vertex_normal(a.tangent));
  at.handedness = vertex_handedness(a.tangent) * ((instance.flags & kInstanceMirrored) != 0u ? -1.0 : 1.0);
  footprint_uv = footprint_m * uintBitsToFloat(corners.w);
#endif

  HitPoint point;
  point.surface = shade_surface(material, at, vec2(footprint_uv));
  point.position_ws = ray.origin_ws + hit.t * ray.direction_ws;
  const bool behind = dot(outward, ray.direction_ws) > 0.0;
  point.geometric_normal_ws = behind ? -outward : outward;
  if (behind) point.surface.normal_ws = -point.surface.normal_ws;
  point.surface.normal_ws = visible_shading_normal(point.surface.normal_ws, point.geometric_normal_ws, -ray.direction_ws);
  point.brdf = make_brdf(clamp(point.surface.base_color.rgb, 0.0, 1.0), clamp(point.surface.metallic, 0.0, 1.0),
                         point.surface.roughness, material.f0_dielectric, material.specular_factor);
  point.material_flags = material.flags;
  point.from_behind = behind;
  point.medium_transmittance = vec3(1.0);
#ifdef HAS_LOBES
  add_lobes(point, shade_lobes(instance.material, material, at, vec2(footprint_uv)), ray, hit.t, behind);
#endif
  return point;
}
