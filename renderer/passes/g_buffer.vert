#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/scene_data.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uvec2 normal_tangent;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 color;
layout(location = 4) in uint instance_number;

out vec3 world_position;
out vec3 world_normal;
#ifdef HAS_TEXTURES
out vec4 world_tangent;
out vec4 texture_uv;
out vec4 vertex_color_factor;
#endif
flat out uint material_index;

void main() {
  const Instance instance = fetch_instance(instance_number);
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
