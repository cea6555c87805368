// One triangle that covers the viewport and hands the camera's block on: see FLAT_CAMERA in shaders/camera.glsl.
#include "passes/bindings.glsl"
#include "shaders/camera.glsl"

out FlatCamera {
  flat vec4 eye_ws;
  flat vec4 right_ws;
  flat vec4 down_ws;
  flat vec4 forward_ws;
  flat ivec4 size_px;
} flat_camera;

void main() {
  flat_camera.eye_ws = camera.eye_ws;
  flat_camera.right_ws = camera.right_ws;
  flat_camera.down_ws = camera.down_ws;
  flat_camera.forward_ws = camera.forward_ws;
  flat_camera.size_px = camera.size_px;
  const vec2 corner = vec2((gl_VertexID & 1) != 0 ? 3.0 : -1.0, (gl_VertexID & 2) != 0 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
