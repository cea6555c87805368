// Which views of a frame are found by rays, and which by rasterising.
#pragma once

#include <glm/glm.hpp>

#include "renderer/passes/camera_block.h"
#include "renderer/passes/device_scene.h"
#include "renderer/tracing/view_tracer.h"

namespace lightwell {

struct ViewTracing {
  ViewTracer* tracer = nullptr;  // null: everything is rasterised
  bool always = false;           // wherever it can be, not just where it is quicker

  /// The tracer for a view of the scene with so many pixels; null where that is to be rasterised: where triangles are
  /// too few or pixels too many (16 million), or where some surfaces hide only part of what is behind them (alpha masks
  /// and blends, clear surfaces).
  ViewTracer* for_view(const DeviceScene& scene, glm::ivec2 size_px) const;
};

/// The frame's camera, as a view that may be traced.
struct CameraView {
  const CameraBlock& block;
  ViewTracing tracing;
};

/// The rays of a camera: t is the depth of view that shaders/camera.glsl speaks of.
ViewRays camera_rays(const CameraBlock& camera);

/// Those of a light's view. It looks from `position_ws` within a pyramid, whose far plane is at t = 1, or, where
/// `placed` is false, along parallel rays on which t is the depth of `clip_from_world`, 0 to 1.
ViewRays light_rays(const glm::mat4& clip_from_world, bool placed, glm::vec3 position_ws, int size_px);

}  // namespace lightwell
