// What a method is given for one frame: the scene on the device, the pose, the camera, the settings.
#pragma once

#include "renderer/gl/stage_timer.h"
#include "renderer/passes/device_scene.h"
#include "renderer/passes/view_choice.h"
#include "renderer/renderer.h"
#include "renderer/tracing/tracer.h"
#include "renderer/tracing/triangle_groups.h"

namespace lightwell {

struct FrameContext {
  const DeviceScene& scene;
  const Pose& pose;
  const Settings& settings;
  glm::ivec2 size_px;
  std::uint32_t frame_number;  // within an accumulation; 0 for the first
  bool accumulate;
  Tracer& tracer;
  TriangleGroups& triangle_groups;  // to be updated by whom needs them
  const TraceScene& trace_scene;    // what the tracer was updated with
  gl::StageTimer& timer;
  CameraView camera;       // its block is bound
  std::uint64_t rays = 0;  // traced in this frame
};

}  // namespace lightwell
