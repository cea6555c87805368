// The realtime method before and behind clear panes, by amounts worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/image/clear_scenes.h"
#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// The middle of the picture, averaged over frames.
glm::vec3 center_of(const Scene& scene, const PlacedCamera& camera, const Settings& settings, int frames) {
  Film film(camera, settings, {9, 9});
  glm::vec3 sum(0.0f);
  for (int frame = 0; frame < frames; ++frame) sum += film.next(scene).center();
  return sum / static_cast<float>(frames);
}

/// A small floor under a wide pane at half a metre, looked at from below the pane.
SceneMaker under_wide_pane(const Material& material) {
  SceneMaker maker;
  maker.quad({-0.01f, 0, -0.01f}, {0, 0, 0.02f}, {0.02f, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  maker.quad({-400, 0.5f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(material));
  return maker;
}

const PlacedCamera kOnSmallFloor = look_at({0.02f, 0.1f, 0.0f}, {0, 0, 0}, 0.1f);

TEST(RealtimeThroughPanes, RaysToTheSkyAreTinted) {
  SceneMaker maker = under_wide_pane(pane(kTint));
  add_white_sky(maker.scene());
  expect_near(center_of(maker.take(), kOnSmallFloor, realtime_settings(1), 48), 0.5f * kTint, 0.02f);
}

// By samples of the ceiling as by rays: both pass two panes.
TEST(RealtimeThroughPanes, RaysToALampPassEveryPane) {
  SceneMaker maker = under_wide_pane(pane(kTint));
  maker.quad({-400, 0.7f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(pane({0.5f, 0.6f, 0.7f})));
  maker.quad({-400, 0.9f, -400}, {800, 0, 0}, {0, 0, 800}, maker.material(lambert(glm::vec3(0), glm::vec3(3.0f))));
  expect_near(center_of(maker.take(), kOnSmallFloor, realtime_settings(1), 64),
              1.5f * kTint * glm::vec3(0.5f, 0.6f, 0.7f), 0.02f);
}

TEST(RealtimeThroughPanes, APaneAddsItsOwnLight) {
  Material shining = pane(kTint);
  shining.emissive_factor = glm::vec3(0.25f);
  SceneMaker maker = under_wide_pane(shining);
  maker.quad({-400, 0.9f, -400}, {800, 0, 0}, {0, 0, 800}, maker.material(lambert(glm::vec3(0), glm::vec3(3.0f))));
  expect_near(center_of(maker.take(), kOnSmallFloor, realtime_settings(1), 64),
              0.5f * (3.0f * kTint + glm::vec3(0.25f)), 0.02f);
}

TEST(RealtimeBehindPanes, ALitFloorShowsItsDirectLightTinted) {
  SceneMaker maker = floor_under(pane(kTint), 0.5f);
  maker.directional({0.3f, -1, 0.1f}, 10.0f);
  const float cosine = 1.0f / std::sqrt(1.1f);
  expect_near(center_of(maker.take(), kOverThePane, realtime_settings(0), 1),
              kTint * kTint * (0.5f / kPi * 10.0f * cosine), 0.01f);
}

TEST(RealtimeBehindPanes, AFloorShowsItsIndirectLightTinted) {
  SceneMaker maker;
  maker.quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  maker.quad({-400, 0.5f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(pane(kTint)));
  add_white_sky(maker.scene());
  for (const ViewKind view : {ViewKind::kFinal, ViewKind::kIndirect}) {
    Settings settings = realtime_settings(1);
    settings.view = view;
    expect_near(center_of(maker.scene(), kOverThePane, settings, 48), kTint * kTint * 0.5f, 0.02f);
  }
}

TEST(RealtimeBehindPanes, TheBackgroundIsTintedAndReflected) {
  SceneMaker maker;
  maker.quad({-2, 0.5f, -2}, {0, 0, 4}, {4, 0, 0}, maker.material(pane(kTint, 1.0f)));
  add_white_sky(maker.scene());
  expect_near(center_of(maker.take(), kOverThePane, realtime_settings(1), 8), 0.96f * kTint + 0.04f, 0.01f);
}

// A pane that passes half and reflects half by its diffuse base.
TEST(RealtimeBehindPanes, APaneReflectsWhatItDoesNotPass) {
  Material half = pane(glm::vec3(0.8f, 0.6f, 0.4f));
  half.transmission_factor = 0.5f;
  SceneMaker maker = floor_under(half, 0.5f);
  maker.directional({0, -1, 0}, 10.0f);
  const glm::vec3 albedo = 0.5f * glm::vec3(0.8f, 0.6f, 0.4f);
  expect_near(center_of(maker.take(), kOverThePane, realtime_settings(0), 1),
              10.0f / kPi * (albedo + albedo * albedo * 0.5f), 0.01f);
}

// Which rays pass, and which end at the pane, is the same in every run.
TEST(RealtimeBehindPanes, TheSameFramesHaveTheSameBytes) {
  SceneMaker maker = floor_under(pane(kTint, 1.0f), 0.5f);
  maker.point({0.5f, 0.3f, 0.2f}, 2.0f);
  add_white_sky(maker.scene());
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 1.5f, 1}, {0, 0, 0}, 1.0f);
  Film first(camera, realtime_settings(3)), second(camera, realtime_settings(3));
  for (int frame = 0; frame < 6; ++frame) EXPECT_EQ(first.next(scene).rgb, second.next(scene).rgb) << frame;
}

}  // namespace
}  // namespace lightwell::testing
