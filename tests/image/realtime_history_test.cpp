// The realtime method over time: what stands still gets better and does not flicker, what changes is there at once.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "renderer/scene/builtin.h"
#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

/// A room with two lamps of `first_candela` and of `candela`, and a box whose left side is at `x`.
Scene furnished_room(float candela, float x, float first_candela = 3.0f) {
  SceneMaker maker;
  const int white = maker.material(lambert(glm::vec3(0.6f)));
  const int blue = maker.material(lambert({0.2f, 0.3f, 0.7f}));
  maker.room({-1, -1, -1}, {1, 1, 1}, white);
  const glm::vec3 low(x, -0.999f, -0.7f), wide(0.4f, 0, 0), high(0, 0.8f, 0), deep(0, 0, 0.4f);
  maker.quad(low + high, deep, wide, blue);
  maker.quad(low + deep, wide, high, blue);
  maker.quad(low + wide + deep, -deep, high, blue);
  maker.quad(low, deep, high, blue);
  maker.quad(low + wide, -wide, high, blue);
  maker.point({-0.3f, 0.6f, 0.3f}, first_candela);
  maker.point({0.5f, 0.2f, 0.4f}, candela);
  return maker.take();
}

/// Mean of a part of the picture.
double mean_of(const Pixels& pixels, glm::ivec2 low, glm::ivec2 high) {
  double sum = 0.0;
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x) sum += static_cast<double>(pixels.at(x, y).g);
  return sum / ((high.x - low.x) * (high.y - low.y));
}

double mean_of(const Pixels& pixels) {
  return mean_of(pixels, {0, 0}, pixels.size_px);
}

/// Mean of (a - b)^2 / (b^2 + 0.01) for pictures whose mean is about 1.
double relative_error(const Pixels& a, const Pixels& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double difference = static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]);
    sum += difference * difference / (static_cast<double>(b.rgb[i]) * static_cast<double>(b.rgb[i]) + 0.01);
  }
  return sum / static_cast<double>(a.rgb.size());
}

TEST(RealtimeHistory, ASwitchedLampIsThereWithinEightFrames) {
  const Scene off = furnished_room(0.0f, -0.7f), on = furnished_room(6.0f, -0.7f);
  Settings settings = realtime_settings(8);
  settings.view = ViewKind::kIndirect;  // direct light has no history
  settings.indirect_size = 64;
  for (const bool switched_on : {true, false}) {
    const Scene& before = switched_on ? off : on;
    const Scene& after = switched_on ? on : off;
    Film settled(kInRoom, settings, {64, 64}), film(kInRoom, settings, {64, 64});
    const double last = static_cast<double>(settled.mean_after(after, 96, 8).g);
    for (int frame = 0; frame < 31; ++frame) film.next(before);
    const double first = mean_of(film.next(before));
    double left[30];
    for (double& share : left) share = (mean_of(film.next(after)) - last) / (first - last);
    std::printf("lamp switched %s: %.2f %% left after 8 frames, %.2f %% after 30\n", switched_on ? "on" : "off",
                100.0 * left[7], 100.0 * left[29]);
    EXPECT_LT(std::abs(left[7]), 0.1);
    EXPECT_LT(std::abs(left[29]), 0.01);
  }
}

// An automatic exposure would make a picture of whatever little is left.
TEST(RealtimeHistory, WhereAllLampsGoOutItIsDarkAtOnce) {
  const Scene on = furnished_room(6.0f, -0.7f), off = furnished_room(0.0f, -0.7f, 0.0f);
  for (const bool temporal_antialiasing : {false, true}) {
    Settings settings = realtime_settings(8);
    settings.temporal_antialiasing = temporal_antialiasing;
    Film film(kInRoom, settings, {64, 64});
    for (int frame = 0; frame < 8; ++frame) film.next(on);
    for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(mean_of(film.next(off)), 0.0) << frame << temporal_antialiasing;
    for (int frame = 0; frame < 8; ++frame) film.next(on);
    EXPECT_GT(mean_of(film.next(on)), 0.1);
  }
}

TEST(RealtimeHistory, ATeleportedBoxLeavesNoGhost) {
  const Scene here = furnished_room(2.0f, -0.8f), there = furnished_room(2.0f, 0.4f);
  Settings settings = realtime_settings(2);
  const Pixels truth = render(there, kInRoom, reference_settings(2), {32, 32}, 256);
  Film film(kInRoom, settings);
  for (int frame = 0; frame < 32; ++frame) film.next(here);
  for (int frame = 0; frame < 7; ++frame) film.next(there);
  const Pixels pixels = film.next(there);
  // Where the box was seen, and where its shadow and its colour lay.
  const glm::ivec2 low(4, 14), high(14, 28);
  const double ghost = mean_of(pixels, low, high) / mean_of(truth, low, high) - 1.0;
  std::printf("after 8 frames a teleported box leaves %+.2f %%\n", 100.0 * ghost);
  EXPECT_LT(std::abs(ghost), 0.02);
}

// Where few rays find the light, all frames of a texel may have missed it: what its neighbours know keeps it from being
// black for certain.
TEST(RealtimeHistory, RareLightInMotionLeavesNoBlackTexels) {
  const Scene scene = builtin_scene("atrium").value();
  const auto view = shared_renderer().make_view();
  FrameRequest request;
  request.size_px = {128, 96};
  request.settings = realtime_settings(2);
  request.settings.samples = 32;
  request.settings.indirect_size = 128;
  request.settings.view = ViewKind::kIndirect;
  request.want_linear = true;
  Pixels pixels{request.size_px, {}};
  for (int frame = 0; frame < 8; ++frame) {
    request.time_s = frame / 15.0;
    request.camera = pose_at(scene, request.time_s).cameras.at(0);
    Result<Frame> rendered = shared_renderer().render(scene, request, *view);
    ASSERT_TRUE(rendered.ok());
    pixels.rgb = std::move(rendered->linear_rgb);
  }
  int black = 0;
  for (int y = 1; y + 1 < request.size_px.y; ++y)
    for (int x = 1; x + 1 < request.size_px.x; ++x) {
      float around = 0.0f;
      for (int i = 0; i < 9; ++i) around += pixels.at(x + i % 3 - 1, y + i / 3 - 1).r / 9.0f;
      black += pixels.at(x, y).r < 0.05f * around;
    }
  std::printf("%d of %d pixels are far darker than what is around them\n", black, 126 * 94);
  EXPECT_LT(black, 126 * 94 / 100);
}

TEST(RealtimeHistory, AStillPictureConvergesAndDoesNotFlicker) {
  const Scene scene = furnished_room(2.0f, -0.7f);
  const Pixels truth = render(scene, kInRoom, reference_settings(2), {32, 32}, 512);
  Film film(kInRoom, realtime_settings(2));
  const double early = relative_error(film.next(scene), truth);
  for (int frame = 0; frame < 94; ++frame) film.next(scene);
  const double late = relative_error(film.next(scene), truth);
  std::vector<double> sums(truth.rgb.size()), squares(truth.rgb.size());
  constexpr int kFrames = 30;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Pixels pixels = film.next(scene);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto value = static_cast<double>(pixels.rgb[i]);
      sums[i] += value;
      squares[i] += value * value;
    }
  }
  double flicker = 0.0, light = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double mean = sums[i] / kFrames;
    flicker += std::sqrt(std::max(0.0, squares[i] / kFrames - mean * mean));
    light += mean;
  }
  std::printf("error %.5f in the first frame, %.5f in the 96th; flicker %.3f %% of the mean\n", early, late,
              100.0 * flicker / light);
  EXPECT_LT(late, 0.5 * early);
  EXPECT_LT(flicker, 0.005 * light);
}

TEST(RealtimeHistory, TheSameFramesHaveTheSameBytes) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f), glm::vec3(0.1f))));
  maker.point({0.2f, 0.3f, 0.1f}, 3.0f);
  const Scene scene = maker.take();
  Film first(kInRoom, realtime_settings(3)), second(kInRoom, realtime_settings(3));
  for (int frame = 0; frame < 8; ++frame) EXPECT_EQ(first.next(scene).rgb, second.next(scene).rgb) << frame;
}

}  // namespace
}  // namespace lightwell::testing
