// What the middle of a pixel sees: ViewRasterizer::camera_hits. Needs seen_point, ray, fetch_hit.

#if defined(HAS_TEXTURES) || defined(FILTER_SPECULAR)
#define NEEDS_STEPS 1
#endif

layout(binding = UNIT_POSITIONS) uniform samplerBuffer positions;  // object space, by vertex

vec3 corner_position(uint vertex) { return texelFetch(positions, int(vertex)).xyz; }

#ifdef NEEDS_STEPS
// How the weights of the second and third corner change to a neighbouring pixel: along the triangle's plane, from where
// this pixel's ray meets it to where the other does, which passes by at `step_ws`.
vec2 weight_step(vec3 edge_b, vec3 edge_c, vec3 ray_ws, vec3 step_ws) {
  const float kLeast = 1e-30;
  const vec3 normal = cross(edge_b, edge_c);
  const float along = dot(normal, ray_ws);
  const float bounded = along < 0.0 ? min(along, -kLeast) : max(along, kLeast);
  const vec3 in_plane = step_ws - ray_ws * (dot(normal, step_ws) / bounded);
  return vec2(dot(normal, cross(in_plane, edge_c)), dot(normal, cross(edge_b, in_plane))) / max(dot(normal, normal), kLeast);
}

vec3 mapped_change(vec3 a, vec3 b, vec3 c, vec2 change) { return change.x * (b - a) + change.y * (c - a); }
vec4 mapped_change(vec4 a, vec4 b, vec4 c, vec2 change) { return change.x * (b - a) + change.y * (c - a); }
#endif

#ifdef MOTION
#include "shaders/displacement.glsl"
layout(binding = UNIT_INSTANCES_BEFORE) uniform usamplerBuffer instances_before;  // 4 texels an instance

vec3 displacement_of(Hit hit, Instance instance, uvec3 corners, vec3 p[3], vec3 weight) {
  const int first = int(4u * hit.instance);
  vec4 before[3];
  for (int i = 0; i < 3; ++i) before[i] = uintBitsToFloat(texelFetch(instances_before, first + i));
  vec3 within = vec3(0.0);
#ifdef DEFORMED_MOTION
  const uint first_before = texelFetch(instances_before, first + 3).x;
  for (int i = 0; i < 3; ++i)
    within += weight[i] * moved_within_mesh(first_before, corners[i] - instance.first_vertex, p[i]);
#endif
  return displacement(instance, before, weight.x * p[0] + weight.y * p[1] + weight.z * p[2], within);
}
#endif

SeenPoint seen_point() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const Hit hit = fetch_hit(pixel.y * camera.size_px.x + pixel.x);
  if (hit.t < 0.0) discard;
  const Instance instance = fetch_instance(hit.instance);
  const vec3 weight = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
  const uvec4 normals = triangle_normals(instance, hit.triangle);
  // Each in the world first, as the vertex shader has them.
  const vec3 normal_a = transform_normal(instance, vertex_normal(normals.x));
  const vec3 normal_b = transform_normal(instance, vertex_normal(normals.y));
  const vec3 normal_c = transform_normal(instance, vertex_normal(normals.z));
  const vec3 mixed_normal = normal_a * weight.x + normal_b * weight.y + normal_c * weight.z;
  const bool perspective = camera.eye_ws.w > 0.5;
  const vec3 through_pixel = camera_ray_ws(gl_FragCoord.xy);

  SeenPoint seen;
  seen.material = instance.material;
  seen.view_depth_m = hit.t;
  seen.position_ws = camera.eye_ws.xyz + (perspective ? through_pixel * hit.t : through_pixel + camera.forward_ws.xyz * (hit.t - 1.0));
  seen.at = plain_attributes(normalize(mixed_normal));
  seen.footprint = vec2(0.0);
  seen.geometric_normal_ws = transform_normal(instance, vertex_normal(normals.w));

#if defined(NEEDS_STEPS) || defined(MOTION)
  const uvec3 corners = triangle_corners(instance, hit.triangle).xyz;
  const vec3 p[3] = vec3[3](corner_position(corners.x), corner_position(corners.y), corner_position(corners.z));
#endif
#ifdef NEEDS_STEPS
  const vec3 edge_b = transform_vector(instance, p[1] - p[0]), edge_c = transform_vector(instance, p[2] - p[0]);
  const vec3 ray_ws = perspective ? through_pixel : camera.forward_ws.xyz;
  const vec2 pixel_m = 2.0 / vec2(camera.size_px.xy) * (perspective ? hit.t : 1.0);
  const vec2 across = weight_step(edge_b, edge_c, ray_ws, pixel_m.x * camera.right_ws.xyz);
  const vec2 down = weight_step(edge_b, edge_c, ray_ws, pixel_m.y * camera.down_ws.xyz);
#endif
#ifdef HAS_TEXTURES
  const Vertex a = fetch_vertex(corners.x);
  const Vertex b = fetch_vertex(corners.y);
  const Vertex c = fetch_vertex(corners.z);
  const float mirror = (instance.flags & kInstanceMirrored) != 0u ? -1.0 : 1.0;
  seen.at.tangent_ws = transform_vector(instance, vertex_normal(a.tangent) * weight.x + vertex_normal(b.tangent) * weight.y +
                                                      vertex_normal(c.tangent) * weight.z);
  seen.at.handedness = mirror * vertex_handedness(a.tangent);
  const vec4 uv_a = vec4(a.uv0, a.uv1), uv_b = vec4(b.uv0, b.uv1), uv_c = vec4(c.uv0, c.uv1);
  const vec4 uv = uv_a * weight.x + uv_b * weight.y + uv_c * weight.z;
  seen.at.uv0 = uv.xy;
  seen.at.uv1 = uv.zw;
  seen.at.color = vertex_color(a.color) * weight.x + vertex_color(b.color) * weight.y + vertex_color(c.color) * weight.z;
  seen.footprint = footprint_of(mapped_change(uv_a, uv_b, uv_c, across), mapped_change(uv_a, uv_b, uv_c, down));
#endif
#ifdef FILTER_SPECULAR
  const float inverse_length = inversesqrt(max(dot(mixed_normal, mixed_normal), 1e-30));
  const vec3 n_across = mapped_change(normal_a, normal_b, normal_c, across) * inverse_length;
  const vec3 n_down = mapped_change(normal_a, normal_b, normal_c, down) * inverse_length;
  seen.normal_across = n_across - seen.at.normal_ws * dot(seen.at.normal_ws, n_across);
  seen.normal_down = n_down - seen.at.normal_ws * dot(seen.at.normal_ws, n_down);
#endif
#ifdef MOTION
  seen.displacement_ws = displacement_of(hit, instance, corners, p, weight);
#endif
  return seen;
}
