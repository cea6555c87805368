// Frames of the realtime method one after the other, as a stream makes them.
#pragma once

#include <gtest/gtest.h>

#include "tests/image/reference_scenes.h"

namespace lightwell::testing {

inline Settings realtime_settings(int bounces) {
  Settings settings;
  settings.method = Method::kRealtime;
  settings.bounces = bounces;
  settings.samples = 64;  // four a frame
  settings.indirect_size = 32;
  return settings;
}

/// Frames one after the other of one view, as a stream makes them.
class Film {
 public:
  Film(const PlacedCamera& camera, const Settings& settings, glm::ivec2 size_px = {32, 32})
      : view_(shared_renderer().make_view()) {
    request_.camera = camera;
    request_.settings = settings;
    request_.size_px = size_px;
    request_.want_linear = true;
    request_.want_display = false;
  }
  FrameRequest& request() { return request_; }

  Pixels next(const Scene& scene) {
    Result<Frame> frame = shared_renderer().render(scene, request_, *view_);
    EXPECT_TRUE(frame.ok()) << (frame.ok() ? "" : frame.error().message());
    for (const std::string& message : shared_renderer().context().take_debug_messages())
      ADD_FAILURE() << "GL: " << message;
    clamped_share_ = frame ? frame->clamped_share : 0.0f;
    return {request_.size_px, frame ? std::move(frame->linear_rgb) : std::vector<float>(3)};
  }

  /// Frame::clamped_share of the last one.
  float clamped_share() const { return clamped_share_; }

  /// Renders a frame; whether it was given up.
  bool is_given_up(const Scene& scene) {
    const Result<Frame> frame = shared_renderer().render(scene, request_, *view_);
    EXPECT_TRUE(frame.ok() || frame.error().kind == ErrorKind::kUnwanted);
    return !frame.ok();
  }

  /// The mean of `counted` frames after `first` others.
  glm::vec3 mean_after(const Scene& scene, int first, int counted) {
    for (int i = 0; i < first; ++i) next(scene);
    glm::vec3 sum(0.0f);
    for (int i = 0; i < counted; ++i) sum += next(scene).mean();
    return sum / static_cast<float>(counted);
  }

 private:
  std::unique_ptr<RenderView> view_;
  FrameRequest request_;
  float clamped_share_ = 0.0f;
};

/// Within a room from -1 to 1.
inline const PlacedCamera kInRoom = look_at({0.1f, 0.05f, 0.9f}, {0, -0.2f, -1}, 1.1f);

}  // namespace lightwell::testing
