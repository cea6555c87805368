// The frame budget of the realtime method, by simulated times.
#include "renderer/methods/frame_budget.h"

#include <gtest/gtest.h>

namespace lightwell {
namespace {

Settings wanted_settings(int target_fps) {
  Settings settings;
  settings.method = Method::kRealtime;
  settings.samples = 128;
  settings.indirect_size = 256;
  settings.target_fps = target_fps;
  return settings;
}

/// A device on which a frame takes so long, and so much more for each ray and each texel of the map.
struct Device {
  double fixed_ms, ray_ns, texel_ns = 0.0;
  double of_map_ms(const Settings& settings) const {
    return static_cast<double>(settings.indirect_size) * settings.indirect_size * texel_ns * 1e-6;
  }
  double of_rays_ms(const Settings& settings) const {
    const double texels = static_cast<double>(settings.indirect_size) * settings.indirect_size;
    return texels * settings.samples / 16.0 * ray_ns * 1e-6;
  }
};

/// What the last of so many frames was made with, and how long it took.
struct Outcome {
  Settings settings;
  double ms;
  int changes;  // of quality on the way
};

Outcome run(FrameBudget& budget, const Settings& wanted, const Device& device, int frames, double noise = 0.0) {
  Outcome outcome{wanted, 0.0, 0};
  int level = budget.level();
  for (int frame = 0; frame < frames; ++frame) {
    outcome.settings = budget.within(wanted);
    const double wobble = 1.0 + noise * (frame % 3 - 1);
    const double of_rays_ms = device.of_rays_ms(outcome.settings) * wobble;
    const double of_map_ms = device.of_map_ms(outcome.settings) * wobble;
    outcome.ms = device.fixed_ms * wobble + of_rays_ms + of_map_ms;
    budget.note({outcome.ms, of_rays_ms, of_map_ms});
    if (budget.level() != level) ++outcome.changes;
    level = budget.level();
  }
  return outcome;
}

TEST(FrameBudget, WithoutATargetNothingChanges) {
  FrameBudget budget;
  const Outcome outcome = run(budget, wanted_settings(0), {1000.0, 1000.0}, 50);
  EXPECT_EQ(outcome.settings.samples, 128);
  EXPECT_EQ(outcome.settings.indirect_size, 256);
}

TEST(FrameBudget, AFastDeviceKeepsWhatIsSet) {
  FrameBudget budget;
  const Outcome outcome = run(budget, wanted_settings(30), {5.0, 20.0}, 50);
  EXPECT_EQ(outcome.settings.samples, 128);
  EXPECT_EQ(outcome.changes, 0);
}

TEST(FrameBudget, ASlowDeviceHoldsTheRateWithinAFewFrames) {
  for (const int fps : {10, 20, 30}) {
    FrameBudget budget;
    const Outcome outcome = run(budget, wanted_settings(fps), {15.0, 300.0}, 12);
    EXPECT_LE(outcome.ms, 1000.0 / fps) << fps;
    EXPECT_LE(outcome.changes, 2) << fps;
  }
}

TEST(FrameBudget, GivesUpNoMoreThanItMust) {
  FrameBudget budget;
  const Device device{15.0, 300.0};
  run(budget, wanted_settings(20), device, 20);
  const int level = budget.level();
  ASSERT_GT(level, 0);
  // One step better would take too long.
  Settings better = budget.within(wanted_settings(20));
  better.samples *= 2;
  EXPECT_GT(device.fixed_ms + device.of_rays_ms(better), 50.0);
}

TEST(FrameBudget, PatchesOfTwoShareRaysBeforeTheMapBecomesSmaller) {
  constexpr double kOfMap_ns = 40.0, kRay_ns = 300.0;
  for (const int samples : {128, 64, 32, 16, 8}) {
    Settings enough = wanted_settings(30);
    enough.samples = samples;
    Device device{0.0, kRay_ns, kOfMap_ns};
    // Just so much time is left that these samples fit.
    device.fixed_ms = 1000.0 / 30 - 1.0 - device.of_rays_ms(enough) - device.of_map_ms(enough);
    FrameBudget budget;
    const Outcome outcome = run(budget, wanted_settings(30), device, 30);
    EXPECT_EQ(outcome.settings.samples, samples);
    EXPECT_EQ(outcome.settings.indirect_size, 256);
  }
}

TEST(FrameBudget, PatchesOfFourComeLast) {
  // Just so much time is left that the smallest map fits with patches of two.
  Settings enough = wanted_settings(30);
  enough.samples = 8, enough.indirect_size = 32;
  Device device{0.0, 3000.0, 400.0};
  device.fixed_ms = 1000.0 / 30 - 0.05 - device.of_rays_ms(enough) - device.of_map_ms(enough);
  FrameBudget budget;
  const Outcome outcome = run(budget, wanted_settings(30), device, 60);
  EXPECT_EQ(outcome.settings.samples, 8);
  EXPECT_EQ(outcome.settings.indirect_size, 32);
}

TEST(FrameBudget, WhatGrowsWithTheMapAloneIsNotExpectedOfFewerRays) {
  FrameBudget budget;
  const Outcome outcome = run(budget, wanted_settings(30), {10.0, 20.0, 1000.0}, 40);
  EXPECT_LE(outcome.ms, 1000.0 / 30);
  EXPECT_LE(outcome.changes, 2);
  EXPECT_LT(outcome.settings.indirect_size, 256);
}

TEST(FrameBudget, DoesNotSwingWhereTimesWobble) {
  FrameBudget budget;
  run(budget, wanted_settings(30), {15.0, 300.0}, 40, 0.1);
  EXPECT_LE(run(budget, wanted_settings(30), {15.0, 300.0}, 300, 0.1).changes, 1);
}

TEST(FrameBudget, ComesBackWhenTheDeviceIsFreeAgain) {
  FrameBudget budget;
  run(budget, wanted_settings(30), {15.0, 1500.0}, 40);
  ASSERT_GT(budget.level(), 2);
  const Outcome outcome = run(budget, wanted_settings(30), {5.0, 20.0}, 600);
  EXPECT_EQ(budget.level(), 0);
  EXPECT_EQ(outcome.settings.samples, 128);
}

TEST(FrameBudget, ATargetOutOfReachEndsAtTheLeast) {
  FrameBudget budget;
  const Outcome outcome = run(budget, wanted_settings(240), {100.0, 300.0}, 60);
  EXPECT_EQ(outcome.settings.samples, 4);
  EXPECT_EQ(outcome.settings.indirect_size, 32);
}

}  // namespace
}  // namespace lightwell
