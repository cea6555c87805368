// The frame's camera as shaders/camera.glsl reads it.
#pragma once

#include <glm/glm.hpp>

#include "renderer/gl/buffer.h"
#include "renderer/scene/pose.h"

namespace lightwell {

/// std140 mirror of `Camera` in shaders/camera.glsl.
struct CameraBlock {
  glm::mat4 clip_from_world;
  glm::vec4 eye_ws;
  glm::vec4 right_ws;
  glm::vec4 down_ws;
  glm::vec4 forward_ws;
  glm::ivec4 size_px;
};

/// `jitter_px` moves the picture by a part of a pixel, for anti-aliasing over frames. Reversed depth, infinite far
/// plane for perspective cameras; row 0 is the top.
CameraBlock make_camera_block(const PlacedCamera& camera, glm::ivec2 size_px, glm::vec2 jitter_px);

}  // namespace lightwell
