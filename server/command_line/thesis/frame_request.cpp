#include "server/command_line/thesis/frame_request.h"

#include "server/command_line/camera_argument.h"
#include "server/command_line/thesis/printed_tables.h"

namespace lightwell {

FrameRequest square_frame(const Scene& scene, double time_s, int side_px, const Settings& settings) {
  FrameRequest request;
  request.time_s = time_s;
  request.size_px = glm::ivec2(side_px);
  request.settings = settings;
  request.camera = place_camera({}, pose_at(scene, time_s), 1.0f).value();
  return request;
}

int scaled_indirect_side(int indirect_side_px, int side_px) {
  return indirect_side_px * side_px / kPrintedSide_px;
}

}  // namespace lightwell
