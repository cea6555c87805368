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

/// A device on which a frame takes so long, and so much more for each ray.
struct Device {
  double fixed_ms, ray_ns;
  double of_rays_ms(const Settings& settings) const {
    const double rays = static_cast<double>(settings.indirect_size) * settings.indirect_size * (settings.samples / 16);
    return rays * ray_ns * 1e-6;
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
    outcome.ms = device.fixed_ms * wobble + of_rays_ms;
    budget.note(outcome.ms, of_rays_ms);
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
  EXPECT_EQ(outcome.settings.samples, 16);
  EXPECT_EQ(outcome.settings.indirect_size, 32);
}

}  // namespace
}  // namespace lightwell
