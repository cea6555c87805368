#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/vertex_input.glsl"

out vec3 world_position;
out vec3 world_normal;
#ifdef HAS_TEXTURES
out vec4 world_tangent;
out vec4 texture_uv;
out vec4 vertex_color_factor;
#endif
flat out uint material_index;

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
  gl_Position = camera.clip_from_world * vec4(world_position, 1.0);
}
