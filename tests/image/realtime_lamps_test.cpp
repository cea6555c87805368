// The direct light of punctual lamps in the realtime method: few of them without noise, many of them right in the mean.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/image/clear_scenes.h"
#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

constexpr glm::ivec2 kSize_px{64, 64};

/// A floor, and over it a card at `x`, so that some of the floor sees all lamps, some but one of them.
SceneMaker floor_under_card(float x) {
  SceneMaker maker;
  maker.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, maker.material(lambert(glm::vec3(0.5f))));
  maker.quad({x, 0.4f, 0.4f}, {0.8f, 0, 0}, {0, 0, -0.8f}, maker.material(lambert(glm::vec3(0.3f))));
  return maker;
}

const PlacedCamera kOverFloor = look_at({0, 2.5f, 2}, {0, 0, 0}, 0.9f);

constexpr int kMostLamps = 6;

/// `count` lamps of every kind and of different colours, the strongest first.
void add_lamps(SceneMaker& maker, int count) {
  const auto are_left = [&] { return count-- > 0; };
  if (are_left()) maker.directional({0.5f, -1, 0.2f}, 3.0f);
  if (are_left()) maker.point({-0.8f, 1.2f, 0.3f}, 3.0f);
  if (are_left()) maker.point({0.9f, 0.9f, 0.6f}, 2.0f);
  if (are_left()) maker.spot({0.2f, 1.5f, -1}, {-0.2f, -1, 0.5f}, 5.0f, 0.5f);
  if (are_left()) maker.point({0.1f, 0.8f, -0.9f}, 1.0f);
  if (are_left()) maker.spot({-0.5f, 1.5f, 1}, {0.3f, -1, -0.5f}, 2.0f, 0.4f);
  glm::vec3 color(1.0f, 0.8f, 0.6f);
  for (Light& light : maker.scene().lights) {
    light.color = color;
    color = {color.b, color.r, color.g};
  }
}

Scene lit_floor(int lamps, float x) {
  SceneMaker maker = floor_under_card(x);
  add_lamps(maker, lamps);
  return maker.take();
}

Settings with_seed(std::uint32_t seed) {
  Settings settings = realtime_settings(0);
  settings.seed = seed;
  return settings;
}

float card_in(int frame) {
  return -0.6f + 0.1f * static_cast<float>(frame);
}

/// Pixels of a pair of pictures that differ.
int different(const Pixels& a, const Pixels& b) {
  int count = 0;
  for (int y = 0; y < a.size_px.y; ++y)
    for (int x = 0; x < a.size_px.x; ++x) count += a.at(x, y) != b.at(x, y) ? 1 : 0;
  return count;
}

// What is chosen at random is another choice with another seed and in another frame.
TEST(RealtimeLamps, UpToFourMakeNoNoiseWhileThingsMove) {
  for (int lamps = 1; lamps <= 4; ++lamps) {
    Film first(kOverFloor, with_seed(1), kSize_px), second(kOverFloor, with_seed(2), kSize_px);
    for (int frame = 0; frame < 3; ++frame) {
      const Scene scene = lit_floor(lamps, card_in(frame));
      EXPECT_EQ(different(first.next(scene), second.next(scene)), 0) << lamps << " lamps, frame " << frame;
    }
    const Scene scene = lit_floor(lamps, card_in(3));
    EXPECT_EQ(different(first.next(scene), first.next(scene)), 0) << lamps << " lamps";
  }
}

// A pane lets all lamps' light through, tinted.
TEST(RealtimeLamps, TwoMakeNoNoiseThroughAPane) {
  SceneMaker maker = floor_under_card(0.1f);
  maker.quad({-1.5f, 0.6f, -1.5f}, {0, 0, 3}, {1.5f, 0, 0}, maker.material(pane(kTint)));
  add_lamps(maker, 2);
  const Scene scene = maker.take();
  Film first(kOverFloor, with_seed(1), kSize_px), second(kOverFloor, with_seed(2), kSize_px);
  const Pixels pixels = first.next(scene);
  EXPECT_EQ(different(pixels, second.next(scene)), 0);
  const glm::vec3 truth = render(scene, kOverFloor, reference_settings(0), kSize_px, 64).mean();
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(pixels.mean()[channel], truth[channel], 0.01f * truth[channel]) << channel;
}

// Where an edge or a shadow's edge crosses a pixel, `reference` sees both sides, a single frame one.
TEST(RealtimeLamps, TwoAreLikeReferencePixelByPixelInOneMovingFrame) {
  Film film(kOverFloor, with_seed(1), kSize_px);
  for (int frame = 0; frame < 2; ++frame) film.next(lit_floor(2, card_in(frame)));
  const Scene scene = lit_floor(2, card_in(2));
  const Pixels pixels = film.next(scene);
  const Pixels truth = render(scene, kOverFloor, reference_settings(0), kSize_px, 256);
  int far = 0;
  for (int y = 0; y < kSize_px.y; ++y)
    for (int x = 0; x < kSize_px.x; ++x) {
      const glm::vec3 off = glm::abs(pixels.at(x, y) - truth.at(x, y));
      far += std::max({off.r, off.g, off.b}) > 0.02f * std::max(truth.at(x, y).g, 0.1f) ? 1 : 0;
    }
  std::printf("two lamps: %d of %d pixels are far from reference\n", far, kSize_px.x * kSize_px.y);
  EXPECT_LT(far, kSize_px.x * kSize_px.y / 12);
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(pixels.mean()[channel], truth.mean()[channel], 0.01f * truth.mean()[channel]) << channel;
}

TEST(RealtimeLamps, SixAreRightInTheMean) {
  const Scene scene = lit_floor(kMostLamps, 0.1f);
  Film film(kOverFloor, with_seed(1), kSize_px);
  const glm::vec3 found = film.mean_after(scene, 0, 32);
  const glm::vec3 truth = render(scene, kOverFloor, reference_settings(0), kSize_px, 256).mean();
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(found[channel], truth[channel], 0.01f * truth[channel]) << channel;
}

// Weak lamps behind a wall, three strong ones before it, whichever order they come in.
TEST(RealtimeLamps, TheStrongestOfManyMakeNoNoise) {
  for (const bool weak_first : {true, false}) {
    SceneMaker maker = floor_under_card(0.1f);
    const auto add_weak = [&] {
      for (const float x : {-0.5f, 0.0f, 0.5f}) maker.point({x, -0.5f, 0}, 0.2f);
    };
    if (weak_first) add_weak();
    add_lamps(maker, 3);
    if (!weak_first) add_weak();
    const Scene scene = maker.take();
    Film first(kOverFloor, with_seed(1), kSize_px), second(kOverFloor, with_seed(2), kSize_px);
    EXPECT_EQ(different(first.next(scene), second.next(scene)), 0) << weak_first;
  }
}

TEST(RealtimeLamps, TheSameFramesHaveTheSameBytes) {
  for (const int lamps : {2, kMostLamps}) {
    Film first(kOverFloor, with_seed(1), kSize_px), second(kOverFloor, with_seed(1), kSize_px);
    for (int frame = 0; frame < 3; ++frame) {
      const Scene scene = lit_floor(lamps, card_in(frame));
      EXPECT_EQ(first.next(scene).rgb, second.next(scene).rgb) << lamps << " lamps, frame " << frame;
    }
  }
}

// Lamps come and go within a view, each with its rays.
TEST(RealtimeLamps, MayChangeInNumber) {
  Film film(kOverFloor, with_seed(1), kSize_px);
  for (const int lamps : {2, 0, 4, 1, 6, 3}) {
    const Pixels pixels = film.next(lit_floor(lamps, 0.1f));
    if (lamps > 4) continue;
    Film alone(kOverFloor, with_seed(2), kSize_px);
    EXPECT_EQ(different(pixels, alone.next(lit_floor(lamps, 0.1f))), 0) << lamps;
  }
}

}  // namespace
}  // namespace lightwell::testing
