#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/vertex_input.glsl"

uniform mat4 light_clip_from_world;

out vec3 world_position;
#ifdef HAS_TEXTURES
out vec4 texture_uv;
flat out uint material_index;
#endif

void main() {
  const Instance instance = vertex_instance();
  world_position = transform_point(instance, position);
#ifdef HAS_TEXTURES
  texture_uv = uv;
  material_index = instance.material;
#endif
  gl_Position = light_clip_from_world * vec4(world_position, 1.0);
}
