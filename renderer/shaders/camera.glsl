// The camera of the frame. Needs passes/bindings.glsl. Reversed depth: 1 at the near plane, 0 at infinity.

layout(std140, binding = BINDING_CAMERA) uniform Camera {
  mat4 clip_from_world;
  vec4 eye_ws;           // w: 1 for a perspective, 0 for an orthographic camera
  vec4 right_ws;         // half the picture's width, at distance 1 (perspective) or as it is; w: znear
  vec4 down_ws;          // half its height, downwards: row 0 is the top; w: zfar (orthographic only)
  vec4 forward_ws;       // unit
  ivec4 size_px;         // xy: the picture
} camera;

// From the eye through a point of the picture, not normalised: 1 along the view axis.
vec3 camera_ray_ws(vec2 position_px) {
  const vec2 ndc = 2.0 * position_px / vec2(camera.size_px.xy) - 1.0;
  return camera.forward_ws.xyz + ndc.x * camera.right_ws.xyz + ndc.y * camera.down_ws.xyz;
}

float view_depth(float depth) {
  return camera.eye_ws.w > 0.5 ? camera.right_ws.w / depth
                               : mix(camera.down_ws.w, camera.right_ws.w, depth);
}

vec3 position_from_depth(vec2 position_px, float depth) {
  const vec3 ray = camera_ray_ws(position_px);
  const float z = view_depth(depth);
  return camera.eye_ws.w > 0.5 ? camera.eye_ws.xyz + ray * z
                               : camera.eye_ws.xyz + (ray - camera.forward_ws.xyz) + camera.forward_ws.xyz * z;
}

// Unit, from a surface point towards the camera.
vec3 direction_to_camera(vec3 position_ws) {
  return camera.eye_ws.w > 0.5 ? normalize(camera.eye_ws.xyz - position_ws) : -camera.forward_ws.xyz;
}
