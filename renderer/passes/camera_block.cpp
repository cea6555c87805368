#include "renderer/passes/camera_block.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

namespace {

// Rows of clip coordinates over view coordinates (x right, y up, looking along -z); y is flipped so that row 0 of the
// picture is its top.
glm::mat4 clip_from_view(const Camera& camera, glm::vec2 half_size, float near, float far, glm::vec2 shift_ndc) {
  glm::mat4 rows(0.0f);
  rows[0][0] = 1.0f / half_size.x;
  rows[1][1] = -1.0f / half_size.y;
  if (camera.perspective) {
    rows[0][2] = -shift_ndc.x;
    rows[1][2] = -shift_ndc.y;
    rows[2][3] = near;  // depth = near / distance
    rows[3][2] = -1.0f;
  } else {
    rows[0][3] = shift_ndc.x;
    rows[1][3] = shift_ndc.y;
    rows[2][2] = 1.0f / (far - near);
    rows[2][3] = far / (far - near);
    rows[3][3] = 1.0f;
  }
  return glm::transpose(rows);
}

}  // namespace

CameraBlock make_camera_block(const PlacedCamera& camera, glm::ivec2 size_px, glm::vec2 jitter_px) {
  const glm::vec2 size(size_px);
  const float aspect_ratio = size.x / size.y;
  const Camera& lens = camera.camera;
  const float tangent = std::tan(lens.yfov * 0.5f);
  const glm::vec2 half_size =
      lens.perspective ? glm::vec2(tangent * aspect_ratio, tangent) : glm::vec2(lens.ymag * aspect_ratio, lens.ymag);
  const float near = lens.perspective ? std::max(lens.znear, 1e-4f) : lens.znear;
  const float far = lens.perspective ? 0.0f : std::max(lens.zfar, near + 1e-3f);
  const glm::vec2 shift_ndc = 2.0f * jitter_px / size;
  const glm::mat4& view = camera.world_from_view;
  const glm::vec3 right(view[0]), up(view[1]), forward = -glm::vec3(view[2]), eye(view[3]);

  CameraBlock block;
  block.clip_from_world = clip_from_view(lens, half_size, near, far, shift_ndc) * glm::inverse(view);
  block.eye_ws = glm::vec4(eye, lens.perspective ? 1.0f : 0.0f);
  block.right_ws = glm::vec4(right * half_size.x, near);
  block.down_ws = glm::vec4(-up * half_size.y, far);
  // The ray through a pixel moves against the picture's shift.
  const glm::vec3 shifted = forward - shift_ndc.x * glm::vec3(block.right_ws) - shift_ndc.y * glm::vec3(block.down_ws);
  block.forward_ws = glm::vec4(lens.perspective ? shifted : forward, 0.0f);
  if (!lens.perspective) block.eye_ws += glm::vec4(shifted - forward, 0.0f);
  block.size_px = glm::ivec4(size_px, 0, 0);
  return block;
}

}  // namespace lightwell
