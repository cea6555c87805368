// Light that passes clear panes and blended surfaces, by amounts worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/image/clear_scenes.h"

namespace lightwell::testing {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

const PlacedCamera kUnderThePane = look_at({0.9f, 0.3f, 0.0f}, {0, 0, 0}, 0.3f);

TEST(TintedShadows, ASunThroughAPane) {
  SceneMaker maker = floor_under(pane(kTint), 0.5f);
  maker.directional({0.3f, -1, 0.1f}, 10.0f);
  const float cosine = 1.0f / std::sqrt(1.1f);
  expect_near(render(maker.take(), kUnderThePane, thesis_settings(0)).center(), kTint * (0.5f / kPi * 10.0f * cosine),
              0.01f);
}

TEST(TintedShadows, ALampThroughTwoPanesThatReflect) {
  SceneMaker maker = floor_under(pane(kTint, 1.0f), 0.5f);
  maker.quad({-2, 0.7f, -2}, {0, 0, 4}, {4, 0, 0}, maker.material(pane({0.5f, 0.6f, 0.7f}, 1.0f)));
  maker.point({1.0f, 1.0f, 0.0f}, 4.0f);
  const float cosine = std::sqrt(0.5f), passed = 1.0f - (0.04f + 0.96f * std::pow(1.0f - cosine, 5.0f));
  const glm::vec3 irradiance = glm::vec3(4.0f / 2.0f * cosine) * kTint * glm::vec3(0.5f, 0.6f, 0.7f) * passed * passed;
  expect_near(render(maker.take(), kUnderThePane, thesis_settings(0), {33, 33}).center(), 0.5f / kPi * irradiance,
              0.01f);
}

TEST(TintedShadows, WhatLiesBeforeThePaneIsNotTinted) {
  SceneMaker maker = floor_under(pane(kTint), 0.5f);
  maker.quad({-2, 0.8f, -2}, {0, 0, 1.9f}, {4, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  maker.directional({0, -1, 0}, 10.0f);
  const Pixels pixels = render(maker.take(), look_at({0, 2, -1}, {0, 0.8f, -1}, 0.3f), thesis_settings(0));
  expect_near(pixels.center(), glm::vec3(5.0f / kPi), 0.01f);
}

// A slab of one metre whose half is below the floor: the light is absorbed along the half that it passes.
TEST(TintedShadows, AVolumeAbsorbsUpToWhatStandsInIt) {
  SceneMaker maker;
  maker.quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  Material water = pane(glm::vec3(1.0f), 1.0f);
  water.double_sided = false;
  water.ior = 1.33f;
  water.thickness_factor = 1.0f;
  water.attenuation_distance = 0.5f;
  water.attenuation_color = kTint;
  const int body = maker.material(water);
  maker.quad({-1, 0.5f, -1}, {0, 0, 2}, {2, 0, 0}, body);
  maker.quad({-1, -0.5f, -1}, {2, 0, 0}, {0, 0, 2}, body);
  maker.directional({0, -1, 0}, 10.0f);
  const float f0 = 0.33f * 0.33f / (2.33f * 2.33f);
  const Pixels pixels = render(maker.take(), kUnderThePane, thesis_settings(0));
  expect_near(pixels.center(), kTint * (5.0f / kPi * (1.0f - f0)), 0.01f);
}

TEST(TintedShadows, ABlendedSurfaceTakesItsCoverage) {
  Material half = lambert(glm::vec3(0.8f, 0.1f, 0.1f));
  half.alpha_mode = AlphaMode::kBlend;
  half.base_color_factor.a = 0.25f;
  half.double_sided = true;
  SceneMaker maker = floor_under(half, 0.5f);
  maker.directional({0.3f, -1, 0.1f}, 10.0f);
  const float cosine = 1.0f / std::sqrt(1.1f);
  expect_near(render(maker.take(), kUnderThePane, thesis_settings(0)).center(),
              glm::vec3(0.75f * 0.5f / kPi * 10.0f * cosine), 0.01f);
}

// A hemisphere of light above the pane: the floor gets pi times what the pane passes, averaged over directions.
TEST(ThroughPanes, RaysToTheSkyAreTinted) {
  SceneMaker maker;
  maker.quad({-0.01f, 0, -0.01f}, {0, 0, 0.02f}, {0.02f, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  maker.quad({-400, 0.5f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(pane(kTint)));
  add_white_sky(maker.scene());
  const PlacedCamera camera = look_at({0.02f, 0.1f, 0.0f}, {0, 0, 0}, 0.1f);
  expect_near(render(maker.take(), camera, thesis_settings(1), {9, 9}).center(), 0.5f * kTint, 0.02f);
}

// Two panes, and behind them a ceiling that emits: hits behind clear surfaces, as many as there are.
TEST(ThroughPanes, RaysToALampPassEveryPane) {
  SceneMaker maker;
  maker.quad({-0.01f, 0, -0.01f}, {0, 0, 0.02f}, {0.02f, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  maker.quad({-400, 0.5f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(pane(kTint)));
  maker.quad({-400, 0.7f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(pane({0.5f, 0.6f, 0.7f})));
  maker.quad({-400, 0.9f, -400}, {800, 0, 0}, {0, 0, 800}, maker.material(lambert(glm::vec3(0), glm::vec3(3.0f))));
  const PlacedCamera camera = look_at({0.02f, 0.1f, 0.0f}, {0, 0, 0}, 0.1f);
  Settings settings = thesis_settings(1);
  for (const int patch : {1, 4}) {
    settings.patch = patch;
    expect_near(render(maker.scene(), camera, settings, {9, 9}).center(), 1.5f * kTint * glm::vec3(0.5f, 0.6f, 0.7f),
                0.02f);
  }
}

// What a ray meets first is a pane that emits: its own light and that of the ceiling behind it.
TEST(ThroughPanes, APaneAddsItsOwnLight) {
  SceneMaker maker;
  maker.quad({-0.01f, 0, -0.01f}, {0, 0, 0.02f}, {0.02f, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  Material shining = pane(kTint);
  shining.emissive_factor = glm::vec3(0.25f);
  maker.quad({-400, 0.5f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(shining));
  maker.quad({-400, 0.9f, -400}, {800, 0, 0}, {0, 0, 800}, maker.material(lambert(glm::vec3(0), glm::vec3(3.0f))));
  const PlacedCamera camera = look_at({0.02f, 0.1f, 0.0f}, {0, 0, 0}, 0.1f);
  expect_near(render(maker.take(), camera, thesis_settings(1), {9, 9}).center(),
              0.5f * (3.0f * kTint + glm::vec3(0.25f)), 0.02f);
}

// From within a volume of half a metre: absorbed on the way to its surface. Over directions by the cosine, the mean of
// exp(-a / cos) is 2 E3(a), an exponential integral; E3(1) = 0.109692.
TEST(ThroughPanes, RaysAreAbsorbedFromWhereTheyBegin) {
  SceneMaker maker;
  maker.quad({-0.01f, 0, -0.01f}, {0, 0, 0.02f}, {0.02f, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  Material water = pane(glm::vec3(1.0f));
  water.thickness_factor = 1.0f;
  water.attenuation_distance = 0.5f;
  water.attenuation_color = glm::vec3(std::exp(-1.0f));
  maker.quad({-400, 0.5f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(water));
  add_white_sky(maker.scene());
  const PlacedCamera camera = look_at({0.02f, 0.1f, 0.0f}, {0, 0, 0}, 0.1f);
  Settings settings = thesis_settings(1);
  settings.samples = 1024;
  expect_near(render(maker.take(), camera, settings, {9, 9}).center(), glm::vec3(2.0f * 0.109692f * 0.5f), 0.03f);
}

TEST(BehindPanes, ALitFloorShowsItsDirectLightTinted) {
  SceneMaker maker = floor_under(pane(kTint), 0.5f);
  maker.directional({0.3f, -1, 0.1f}, 10.0f);
  const float cosine = 1.0f / std::sqrt(1.1f);
  expect_near(render(maker.take(), kOverThePane, thesis_settings(0)).center(),
              kTint * kTint * (0.5f / kPi * 10.0f * cosine), 0.01f);
}

// The floor is lit by the sky alone, through the pane, and seen through it: indirect light at the picture's resolution.
TEST(BehindPanes, AFloorShowsItsIndirectLightTinted) {
  SceneMaker maker;
  maker.quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, maker.material(lambert(glm::vec3(0.5f))));
  maker.quad({-400, 0.5f, -400}, {0, 0, 800}, {800, 0, 0}, maker.material(pane(kTint)));
  add_white_sky(maker.scene());
  for (const ViewKind view : {ViewKind::kFinal, ViewKind::kIndirect}) {
    Settings settings = thesis_settings(1);
    settings.view = view;
    expect_near(render(maker.scene(), kOverThePane, settings).center(), kTint * kTint * 0.5f, 0.02f);
  }
}

TEST(BehindPanes, TheBackgroundIsTinted) {
  SceneMaker maker;
  maker.quad({-2, 0.5f, -2}, {0, 0, 4}, {4, 0, 0}, maker.material(pane(kTint, 1.0f)));
  add_white_sky(maker.scene());
  // What the pane does not pass it reflects.
  expect_near(render(maker.take(), kOverThePane, thesis_settings(1)).center(), 0.96f * kTint + 0.04f, 0.01f);
}

// A pane that passes half and reflects half by its diffuse base.
TEST(BehindPanes, APaneReflectsWhatItDoesNotPass) {
  Material half = pane(glm::vec3(0.8f, 0.6f, 0.4f));
  half.transmission_factor = 0.5f;
  SceneMaker maker = floor_under(half, 0.5f);
  maker.directional({0, -1, 0}, 10.0f);
  const glm::vec3 albedo = 0.5f * glm::vec3(0.8f, 0.6f, 0.4f);
  expect_near(render(maker.take(), kOverThePane, thesis_settings(0)).center(),
              10.0f / kPi * (albedo + albedo * albedo * 0.5f), 0.01f);
}

// Straight connections through thin walls have an exact value, which the reference takes, too.
TEST(ReferencePanes, ASunThroughAPaneHasItsExactValue) {
  SceneMaker maker = floor_under(pane(kTint, 1.0f), 0.5f);
  maker.directional({0.3f, -1, 0.1f}, 10.0f);
  const float cosine = 1.0f / std::sqrt(1.1f), passed = 1.0f - (0.04f + 0.96f * std::pow(1.0f - cosine, 5.0f));
  Settings settings = thesis_settings(0);
  settings.method = Method::kReference;
  expect_near(render(maker.scene(), kUnderThePane, settings, {9, 9}, 4).center(),
              kTint * (0.5f / kPi * 10.0f * cosine * passed), 0.002f);
  settings.method = Method::kRealtime;
  expect_near(render(maker.scene(), kUnderThePane, settings, {9, 9}).center(),
              kTint * (0.5f / kPi * 10.0f * cosine * passed), 0.002f);
}

// To pass a clear wall is no bounce: the floor's direct light, seen and lit through it.
TEST(ReferencePanes, AFloorBehindAPaneIsSeenWithoutABounce) {
  SceneMaker maker = floor_under(pane(kTint), 0.5f);
  maker.directional({0.3f, -1, 0.1f}, 10.0f);
  const float cosine = 1.0f / std::sqrt(1.1f);
  Settings settings = thesis_settings(0);
  settings.method = Method::kReference;
  expect_near(render(maker.scene(), kOverThePane, settings, {9, 9}, 4).mean(),
              kTint * kTint * (0.5f / kPi * 10.0f * cosine), 0.002f);
}

}  // namespace
}  // namespace lightwell::testing
