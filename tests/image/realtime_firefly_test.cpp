// The realtime method's firefly clamp: what it takes away is known, told, and nothing else.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

constexpr float kFloorSide_m = 2.0f, kPatchSide_m = 0.5f, kHeight_m = 1.0f;

/// A floor that fills the picture; over it a small patch that faces it, lit from the side and below, so that the floor
/// has no light but what bounces there. `mirror`: of the floor's right half.
Scene under_lit_patch(float lux, bool mirror = false) {
  SceneMaker maker;
  const int white = maker.material(lambert(glm::vec3(0.5f)));
  Material smooth;
  smooth.metallic_factor = 1.0f, smooth.roughness_factor = 0.0f;
  const int right = mirror ? maker.material(smooth) : white;
  maker.quad({-1, 0, -1}, {0, 0, 2}, {1, 0, 0}, white);
  maker.quad({0, 0, -1}, {0, 0, 2}, {1, 0, 0}, right);
  const float half = 0.5f * kPatchSide_m;
  maker.quad({-half, kHeight_m, -half}, {kPatchSide_m, 0, 0}, {0, 0, kPatchSide_m}, white);
  maker.directional({1.0f, 0.5f, 0.0f}, lux);
  return maker.take();
}

const PlacedCamera kOverFloor = look_parallel({0, 3, 0}, {0, 0, 0}, kFloorSide_m);

Settings clamped_settings(float times) {
  Settings settings = realtime_settings(1);
  settings.view = ViewKind::kIndirect;
  settings.firefly_clamp = times;
  return settings;
}

/// The share of the floor's rays, sampled by the cosine, that meet the patch: its form factor.
double share_of_rays_to_patch() {
  constexpr int kFloorSteps = 64, kPatchSteps = 16;
  const auto place = [](int step, int steps, float side) {
    return static_cast<double>(side) * ((step + 0.5) / steps - 0.5);
  };
  double sum = 0.0;
  for (int i = 0; i < kFloorSteps * kFloorSteps; ++i)
    for (int j = 0; j < kPatchSteps * kPatchSteps; ++j) {
      const double dx =
          place(i % kFloorSteps, kFloorSteps, kFloorSide_m) - place(j % kPatchSteps, kPatchSteps, kPatchSide_m);
      const double dz =
          place(i / kFloorSteps, kFloorSteps, kFloorSide_m) - place(j / kPatchSteps, kPatchSteps, kPatchSide_m);
      const double square = dx * dx + dz * dz + 1.0;  // over kHeight_m, as are both cosines
      sum += 1.0 / (square * square);
    }
  const double patch_m2 = static_cast<double>(kPatchSide_m) * static_cast<double>(kPatchSide_m);
  return sum / (kFloorSteps * kFloorSteps) * patch_m2 / (kPatchSteps * kPatchSteps) / std::numbers::pi;
}

struct Shot {
  double mean, clamped_share;
};

Shot shot_of(const Scene& scene, float times, int frames = 64) {
  Film film(kOverFloor, clamped_settings(times));
  for (int frame = 1; frame < frames; ++frame) film.next(scene);
  const double mean = static_cast<double>(film.next(scene).mean().g);
  return {mean, static_cast<double>(film.clamped_share())};
}

// Of the rays a share p brings light B and all others none: the mean is p B, and of B at most N p B is left.
TEST(RealtimeFireflyClamp, TakesAwayWhatItTells) {
  const Scene scene = under_lit_patch(1000.0f);
  const double p = share_of_rays_to_patch();
  const double whole = shot_of(scene, 0.0f).mean;
  for (const float times : {2.0f, 8.0f, 16.0f}) {
    const Shot clamped = shot_of(scene, times);
    const double known = 1.0 - static_cast<double>(times) * p, lost = 1.0 - clamped.mean / whole;
    std::printf("clamped to %2.0f times the mean: %.4f is known to go, %.4f does, %.4f is told\n",
                static_cast<double>(times), known, lost, clamped.clamped_share);
    EXPECT_NEAR(clamped.clamped_share, known, 0.02);
    EXPECT_NEAR(clamped.clamped_share, lost, 0.02);
  }
}

TEST(RealtimeFireflyClamp, IsOffByDefaultAndTakesNothingThatIsUnderIt) {
  const Scene scene = under_lit_patch(1000.0f);
  EXPECT_EQ(Settings().firefly_clamp, 0.0f);
  const Shot off = shot_of(scene, 0.0f, 8), far = shot_of(scene, 1000.0f, 8);
  EXPECT_EQ(off.clamped_share, 0.0);
  EXPECT_EQ(far.clamped_share, 0.0);
  EXPECT_NEAR(far.mean, off.mean, 1e-6 * off.mean);
}

TEST(RealtimeFireflyClamp, ItsShareDoesNotDependOnTheUnitOfLight) {
  const Shot bright = shot_of(under_lit_patch(65536.0f), 8.0f, 8), dim = shot_of(under_lit_patch(0.0625f), 8.0f, 8);
  EXPECT_NEAR(dim.clamped_share, bright.clamped_share, 1e-5);
}

TEST(RealtimeFireflyClamp, LeavesTheLightOfLampsAndTheSkyAlone) {
  SceneMaker lamp;
  lamp.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, lamp.material(lambert(glm::vec3(0.5f))));
  lamp.quad({-0.25f, 0.5f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f}, lamp.material(lambert(glm::vec3(0), glm::vec3(9.0f))));
  SceneMaker sky;
  sky.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, sky.material(lambert(glm::vec3(0.5f))));
  for (const Scene& scene : {lamp.take(), with_white_sky(std::move(sky))}) {
    const Shot off = shot_of(scene, 0.0f, 8), clamped = shot_of(scene, 0.25f, 8);
    EXPECT_EQ(clamped.clamped_share, 0.0);
    EXPECT_NEAR(clamped.mean, off.mean, 1e-6 * off.mean);
  }
}

TEST(RealtimeFireflyClamp, LeavesMirrorsAlone) {
  const Scene scene = under_lit_patch(1000.0f, true);
  Film off(kOverFloor, clamped_settings(0.0f)), clamped(kOverFloor, clamped_settings(1.0f));
  for (int frame = 0; frame < 4; ++frame) {
    const float whole = off.next(scene).at(18, 16).g;
    EXPECT_GT(whole, 50.0f);
    EXPECT_NEAR(clamped.next(scene).at(18, 16).g, whole, 1e-4f * whole);
    EXPECT_GT(clamped.clamped_share(), 0.0f) << "of the matt half";
  }
}

TEST(RealtimeFireflyClamp, TheSameFramesHaveTheSameBytes) {
  const Scene scene = varied_room();
  Settings settings = realtime_settings(3);
  settings.firefly_clamp = 2.0f;
  Film first(before_varied_room(), settings, {48, 32}), second(before_varied_room(), settings, {48, 32});
  for (int frame = 0; frame < 6; ++frame) {
    EXPECT_EQ(first.next(scene).rgb, second.next(scene).rgb) << frame;
    EXPECT_EQ(first.clamped_share(), second.clamped_share());
    EXPECT_GT(first.clamped_share(), 0.0f);
  }
}

TEST(RealtimeFireflyClamp, IsHeldToItsRange) {
  for (const float times : {-1.0f, 2e6f, std::nanf("")}) {
    Settings settings;
    settings.firefly_clamp = times;
    const Status refused = check_settings(settings, {8, 8});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().where, "firefly-clamp");
  }
}

}  // namespace
}  // namespace lightwell::testing
