// The realtime method where texels of the indirect map share a frame's rays: patches of two and of four.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "renderer/passes/patch_grid.h"
#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

Settings shared_rays(int samples, ViewKind view = ViewKind::kIndirect) {
  Settings settings = realtime_settings(2);
  settings.samples = samples;
  settings.view = view;
  return settings;
}

/// A lit room with a box in it: edges of surfaces and of light.
Scene room_with_box() {
  SceneMaker maker;
  const int white = maker.material(lambert(glm::vec3(0.6f))), red = maker.material(lambert({0.7f, 0.3f, 0.2f}));
  maker.room({-1, -1, -1}, {1, 1, 1}, white);
  const glm::vec3 low(-0.3f, -0.999f, -0.5f), wide(0.5f, 0, 0), high(0, 0.7f, 0), deep(0, 0, 0.5f);
  maker.quad(low + high, deep, wide, red);
  maker.quad(low + deep, wide, high, red);
  maker.quad(low, deep, high, red);
  maker.quad(low + wide + deep, -deep, high, red);
  maker.point({0.2f, 0.7f, 0.3f}, 3.0f);
  return maker.take();
}

double relative_error(const Pixels& a, const Pixels& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double truth = static_cast<double>(b.rgb[i]), difference = static_cast<double>(a.rgb[i]) - truth;
    sum += difference * difference / (truth * truth + 1e-4);
  }
  return sum / static_cast<double>(a.rgb.size());
}

TEST(RealtimePatches, EveryTexelHasItsTurn) {
  for (const glm::uvec2 log2_patch : {glm::uvec2(0), glm::uvec2(1, 0), glm::uvec2(1)}) {
    PatchGrid grid;
    grid.map_size_px = {7, 5};
    grid.log2_patch = log2_patch;
    std::set<std::pair<int, int>> places;
    for (grid.frame_number = 8; grid.frame_number < 8 + grid.frames_of_patch(); ++grid.frame_number) {
      const glm::ivec2 place = grid.traced_place();
      EXPECT_TRUE(places.emplace(place.x, place.y).second);
      EXPECT_TRUE(place.x < 1 << log2_patch.x && place.y < 1 << log2_patch.y);
    }
    EXPECT_EQ(places.size(), grid.frames_of_patch());
    EXPECT_EQ(grid.patches() * (1 << glm::ivec2(log2_patch)) / (1 << glm::ivec2(log2_patch)), grid.patches());
    EXPECT_GE(grid.patches().x * (1 << log2_patch.x), 7);
  }
}

// Of a picture whose map has an odd number of texels a side, too.
TEST(RealtimePatches, TheHistoryGrowsByTurns) {
  constexpr int kFrames = 16;
  const Scene scene = room_with_box();
  for (const glm::ivec2 size_px : {glm::ivec2(32), glm::ivec2(31, 29)})
    for (const int samples : {16, 8, 4}) {
      Film film(kInRoom, shared_rays(samples, ViewKind::kHistory), size_px);
      for (int frame = 1; frame < kFrames; ++frame) film.next(scene);
      const double turns = kFrames * samples / 16.0;
      // A borrowed ray counts for a quarter; texels of two surfaces change over between them.
      EXPECT_NEAR(static_cast<double>(film.next(scene).at(size_px.x / 2, 2).g), turns / 64.0, 0.3 / 64.0) << samples;
    }
}

TEST(RealtimePatches, KeepTheMean) {
  const Scene scene = room_with_box();
  for (const int bounces : {1, 2}) {
    const auto mean_of = [&](int samples) {
      Settings settings = shared_rays(samples);
      settings.bounces = bounces;
      settings.indirect_size = 64;
      return static_cast<double>(Film(kInRoom, settings, {64, 64}).mean_after(scene, 96, 32).g);
    };
    const double truth = mean_of(64);
    for (const int samples : {8, 4}) {
      const double mean = mean_of(samples);
      std::printf("%d bounces, patches of %d: mean %+.2f %%\n", bounces, 16 / samples, 100.0 * (mean / truth - 1.0));
      EXPECT_NEAR(mean, truth, 0.01 * truth) << samples;
    }
  }
}

// A smaller map forgets what is known, patches do not.
TEST(RealtimePatches, GoOnWithTheHistoryThatThereIs) {
  const Scene scene = room_with_box();
  Settings exact = reference_settings(2);
  exact.view = ViewKind::kIndirect;
  const Pixels truth = render(scene, kInRoom, exact, {32, 32}, 512);
  const auto error_after = [&](int samples, int indirect_size) {
    Film film(kInRoom, shared_rays(16));
    for (int frame = 0; frame < 32; ++frame) film.next(scene);
    film.request().settings.samples = samples;
    film.request().settings.indirect_size = indirect_size;
    return relative_error(film.next(scene), truth);
  };
  const double before = error_after(16, 32), shared = error_after(4, 32), smaller = error_after(16, 16);
  std::printf("error %.4f; with patches of four %.4f, with a map of half the side %.4f\n", before, shared, smaller);
  EXPECT_LT(shared, 1.1 * before);
  EXPECT_GT(smaller, 2.0 * shared);
}

TEST(RealtimePatches, TheSameFramesHaveTheSameBytes) {
  const Scene scene = varied_room();
  Film first(before_varied_room(), shared_rays(4), {47, 33}), second(before_varied_room(), shared_rays(4), {47, 33});
  for (int frame = 0; frame < 6; ++frame) EXPECT_EQ(first.next(scene).rgb, second.next(scene).rgb) << frame;
}

}  // namespace
}  // namespace lightwell::testing
