// Which views of a frame the processor draws, and which the device.
#pragma once

#include <glm/glm.hpp>

#include "renderer/passes/camera_block.h"
#include "renderer/passes/device_scene.h"
#include "renderer/passes/view_rasterizer.h"

namespace lightwell {

struct ViewChoice {
  ViewRasterizer* rasterizer = nullptr;  // null: the device draws everything
  bool always = false;                   // wherever it can be, not just where it is quicker

  /// For a view of the scene with so many pixels; null where the device is to draw it: where triangles are too few or
  /// pixels too many (16 million), or where some surfaces hide only part of what is behind them (alpha masks and
  /// blends, clear surfaces).
  ViewRasterizer* for_view(const DeviceScene& scene, glm::ivec2 size_px) const;
};

/// The frame's camera, as a view that the processor may draw.
struct CameraView {
  const CameraBlock& block;
  ViewChoice choice;
};

/// The rays of a camera: t is the depth of view that shaders/camera.glsl speaks of.
ViewRays camera_rays(const CameraBlock& camera);

/// Those of a light's view. It looks from `position_ws` within a pyramid, whose far plane is at t = 1, or, where
/// `placed` is false, along parallel rays on which t is the depth of `clip_from_world`, 0 to 1.
ViewRays light_rays(const glm::mat4& clip_from_world, bool placed, glm::vec3 position_ws, int size_px);

}  // namespace lightwell
