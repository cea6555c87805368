// From realtime to reference and back on one view: no step on the way, reference's own picture at the end, and
// realtime's history as good as it was.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "renderer/passes/hand_over.h"
#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

constexpr std::uint32_t kPaths = 256;

Scene lit_room() {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert({0.6f, 0.5f, 0.4f})));
  maker.quad({-0.4f, 0.99f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f},
             maker.material(lambert(glm::vec3(0.0f), glm::vec3(8.0f))));
  return maker.take();
}

FrameRequest still_request() {
  FrameRequest request;
  request.camera = kInRoom;
  request.size_px = {32, 32};
  request.want_linear = true;
  request.settings = realtime_settings(2);
  return request;
}

/// Frames of a view, one after the other, as a session that stands still asks for them.
class Stream {
 public:
  Frame next(const FrameRequest& request, bool accumulate) {
    FrameRequest asked = request;
    asked.accumulate = accumulate;
    Result<Frame> frame = shared_renderer().render(scene, asked, *view_);
    EXPECT_TRUE(frame.ok());
    return frame ? std::move(frame).value() : Frame{};
  }
  Frame refined(const FrameRequest& request, std::uint32_t frames) {
    Frame frame;
    for (std::uint32_t i = 0; i < frames; ++i) frame = next(request, i > 0);
    return frame;
  }
  Scene scene = lit_room();

 private:
  std::unique_ptr<RenderView> view_ = shared_renderer().make_view();
};

FrameRequest by_reference(FrameRequest request, std::uint32_t hand_over_frames) {
  request.settings.method = Method::kReference;
  request.hand_over_frames = hand_over_frames;
  return request;
}

/// Root of the mean of (a - b)^2 over the mean of b.
double difference(const Frame& a, const Frame& b) {
  double squares = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < a.linear_rgb.size(); ++i) {
    squares += std::pow(static_cast<double>(a.linear_rgb[i]) - static_cast<double>(b.linear_rgb[i]), 2.0);
    sum += static_cast<double>(b.linear_rgb[i]);
  }
  const auto count = static_cast<double>(a.linear_rgb.size());
  return std::sqrt(squares / count) / (sum / count);
}

double mean_of(const Frame& frame) {
  double sum = 0.0;
  for (const float value : frame.linear_rgb) sum += static_cast<double>(value);
  return sum / static_cast<double>(frame.linear_rgb.size());
}

TEST(HandOver, TheShareOfPathsGrowsFromLittleToAll) {
  constexpr float kWorth = 64.0f;
  float before = 0.0f;
  for (std::uint32_t paths = 1; paths <= kPaths; ++paths) {
    const float share = share_of_paths(paths, kPaths, kWorth);
    EXPECT_GT(share, before);
    EXPECT_LT(share - before, 0.02f) << paths;
    before = share;
  }
  EXPECT_EQ(share_of_paths(kPaths, kPaths, kWorth), 1.0f);
  EXPECT_EQ(share_of_paths(kPaths + 1, kPaths, kWorth), 1.0f);
}

TEST(HandOver, GoesFromRealtimeToReferenceWithoutAStep) {
  Stream stream;
  Frame before = stream.refined(still_request(), 32);
  const double mean_before = mean_of(before);
  const FrameRequest request = by_reference(still_request(), kPaths);
  double greatest = 0.0, brightest = 0.0;
  for (std::uint32_t i = 0; i < kPaths; ++i) {
    Frame frame = stream.next(request, i > 0);
    EXPECT_EQ(frame.accumulated, i + 1);
    greatest = std::max(greatest, difference(frame, before));
    brightest = std::max(brightest, std::abs(mean_of(frame) / mean_before - 1.0));
    EXPECT_NEAR(frame.exposure_ev, before.exposure_ev, 0.05f);
    before = std::move(frame);
  }
  Stream alone;
  const Frame truth = alone.refined(by_reference(still_request(), 0), kPaths);
  EXPECT_EQ(before.linear_rgb, truth.linear_rgb);  // at the end all is reference's
  const Frame first_path = alone.next(by_reference(still_request(), 0), false);
  std::printf("hand-over: a step of %.4f at most, %.4f in brightness; a first path alone is off by %.3f\n", greatest,
              brightest, difference(first_path, truth));
  EXPECT_LT(greatest, 0.015);
  EXPECT_LT(brightest, 0.02);
}

TEST(HandOver, ComesBackToRealtimeWithItsHistory) {
  const FrameRequest request = still_request();
  Stream truth, anew, stream;
  const Frame exact = truth.refined(by_reference(request, 0), 1024);
  const double of_first = difference(anew.next(request, false), exact);
  for (int i = 0; i < 32; ++i) stream.next(request, false);
  stream.refined(by_reference(request, kPaths), 8);
  const double of_next = difference(stream.next(request, false), exact);
  FrameRequest aside = request;  // the camera has been moved meanwhile
  aside.camera.world_from_view[3].x += 0.02f;
  stream.refined(by_reference(request, kPaths), 8);
  Stream truth_aside;
  const double of_moved = difference(stream.next(aside, false), truth_aside.refined(by_reference(aside, 0), 1024));
  std::printf("error of a first frame %.4f, of one after the paths %.4f, and from elsewhere %.4f\n", of_first, of_next,
              of_moved);
  EXPECT_LT(of_next, 0.5 * of_first);
  EXPECT_LT(of_moved, 0.7 * of_first);
}

TEST(HandOver, APictureOfAnotherSizeStaysOut) {
  Stream stream, alone;
  FrameRequest small = still_request();
  small.size_px = {16, 16};
  stream.next(small, false);
  const FrameRequest request = by_reference(still_request(), kPaths);
  EXPECT_EQ(stream.next(request, false).linear_rgb, alone.next(request, false).linear_rgb);
}

}  // namespace
}  // namespace lightwell::testing
