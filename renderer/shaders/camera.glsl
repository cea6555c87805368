// The camera of the frame. Needs passes/bindings.glsl. Reversed depth: 1 at the near plane, 0 at infinity.
// FLAT_CAMERA, for fragments of passes/full_screen_camera.vert: it comes from the vertices, since a software device reads a
// uniform block once a lane in every fragment shader.

#ifdef FLAT_CAMERA
in FlatCamera {
  flat vec4 eye_ws;
  flat vec4 right_ws;
  flat vec4 down_ws;
  flat vec4 forward_ws;
  flat ivec4 size_px;
} camera;  // members as below
#else
layout(std140, binding = BINDING_CAMERA) uniform Camera {
  mat4 clip_from_world;
  vec4 eye_ws;           // w: 1 for a perspective, 0 for an orthographic camera
  vec4 right_ws;         // half the picture's width, at distance 1 (perspective) or as it is; w: znear
  vec4 down_ws;          // half its height, downwards: row 0 is the top; w: zfar (orthographic only)
  vec4 forward_ws;       // unit
  ivec4 size_px;         // xy: the picture
} camera;
#endif

// From the eye through a point of the picture, not normalised: 1 along the view axis.
vec3 camera_ray_ws(vec2 position_px) {
  const vec2 ndc = 2.0 * position_px / vec2(camera.size_px.xy) - 1.0;
  return camera.forward_ws.xyz + ndc.x * camera.right_ws.xyz + ndc.y * camera.down_ws.xyz;
}

// The block is read before any choice: under one a software device reads it once for each lane.
float view_depth(float depth) {
  const float znear = camera.right_ws.w, zfar = camera.down_ws.w;
  return camera.eye_ws.w > 0.5 ? znear / depth : mix(zfar, znear, depth);
}

// And back.
float depth_of_view(float view_depth_m) {
  const float znear = camera.right_ws.w, zfar = camera.down_ws.w;
  return camera.eye_ws.w > 0.5 ? znear / view_depth_m : (zfar - view_depth_m) / (zfar - znear);
}

vec3 position_from_depth(vec2 position_px, float depth) {
  const vec4 eye_ws = camera.eye_ws;
  const vec3 forward_ws = camera.forward_ws.xyz;
  const vec3 ray = camera_ray_ws(position_px);
  const float z = view_depth(depth);
  return eye_ws.xyz + (eye_ws.w > 0.5 ? ray * z : ray + forward_ws * (z - 1.0));
}

// Unit, from a surface point towards the camera.
vec3 direction_to_camera(vec3 position_ws) {
  const vec4 eye_ws = camera.eye_ws;
  const vec3 backward_ws = -camera.forward_ws.xyz;
  return eye_ws.w > 0.5 ? normalize(eye_ws.xyz - position_ws) : backward_ws;
}
