#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/vertex_input.glsl"

#ifdef LIGHT_VIEW
uniform mat4 light_clip_from_world;
#endif

out vec3 world_position;
out vec3 world_normal;
#ifdef HAS_TEXTURES
out vec4 world_tangent;
out vec4 texture_uv;
out vec4 vertex_color_factor;
#endif
flat out uint material_index;

#ifdef MOTION
#include "shaders/displacement.glsl"
layout(location = 8) in vec4 before_row_x;
layout(location = 9) in vec4 before_row_y;
layout(location = 10) in vec4 before_row_z;
layout(location = 11) in uint first_position_before;
out vec3 displacement_ws;
#endif

void main() {
  const Instance instance = vertex_instance();
  world_position = transform_point(instance, position);
  world_normal = transform_normal(instance, vertex_normal(normal_tangent.x));
#ifdef HAS_TEXTURES
  const float mirror = (instance.flags & kInstanceMirrored) != 0u ? -1.0 : 1.0;
  world_tangent =
      vec4(transform_vector(instance, vertex_normal(normal_tangent.y)), mirror * vertex_handedness(normal_tangent.y));
  texture_uv = uv;
  vertex_color_factor = color;
#endif
  material_index = instance.material;
#ifdef MOTION
  vec3 within = vec3(0.0);
#ifdef DEFORMED_MOTION
  within = moved_within_mesh(first_position_before, uint(gl_VertexID) - instance.first_vertex, position);
#endif
  displacement_ws = displacement(instance, vec4[3](before_row_x, before_row_y, before_row_z), position, within);
#endif
#ifdef LIGHT_VIEW
  gl_Position = light_clip_from_world * vec4(world_position, 1.0);
#else
  gl_Position = camera.clip_from_world * vec4(world_position, 1.0);
#endif
}
