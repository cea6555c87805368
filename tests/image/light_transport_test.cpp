// The thesis method against closed forms: what it computes is light, in the right units, at the right place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/image/test_scenes.h"

namespace lightwell::testing {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

void expect_near_relative(float actual, float expected, float tolerance) {
  EXPECT_NEAR(actual, expected, std::abs(expected) * tolerance);
}

TEST(DirectLight, LambertPlaneUnderOneLuxHasRadianceAlbedoOverPi) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
  maker.directional({0, -1, 0}, 1.0f);
  const Pixels pixels = render(maker.take(), look_at({0, 3, 0.1f}, {0, 0, 0}), thesis_settings(0));
  expect_near_relative(pixels.center().g, 0.5f / kPi, 1e-3f);
}

TEST(DirectLight, PointLightFallsWithTheSquareOfDistance) {
  for (const float distance : {0.5f, 1.0f, 3.0f}) {
    SceneMaker maker;
    maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
    maker.point({0, distance, 0}, 10.0f);
    const Pixels pixels = render(maker.take(), look_at({0, 3, 0.1f}, {0, 0, 0}, 0.1f), thesis_settings(0));
    expect_near_relative(pixels.center().g, 0.5f / kPi * 10.0f / (distance * distance), 5e-3f);
  }
}

TEST(DirectLight, SpotLightIsBrightInsideItsConeAndDarkOutside) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
  maker.spot({0, 2, 0}, {0, -1, 0}, 8.0f, 0.3f);
  const Pixels pixels = render(maker.take(), look_at({0, 4, 0.01f}, {0, 0, 0}, 0.8f), thesis_settings(0));
  expect_near_relative(pixels.center().g, 0.5f / kPi * 8.0f / 4.0f, 5e-3f);
  EXPECT_EQ(pixels.at(1, 1), glm::vec3(0.0f));
}

TEST(DirectLight, WhatStandsBehindAnotherSurfaceIsInShadow) {
  SceneMaker maker;
  const int grey = maker.material(lambert(glm::vec3(0.5f)));
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, grey);
  maker.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, grey);  // faces down, 2 m wide
  for (const bool sun : {true, false}) {
    SceneMaker with_light = maker;
    if (sun)
      with_light.directional({0, -1, 0}, 1.0f);
    else
      with_light.point({0, 2, 0}, 5.0f);
    const Pixels pixels = render(with_light.take(), look_at({0, 0.4f, 3.0f}, {0, 0, 0}, 0.2f), thesis_settings(0));
    EXPECT_LT(pixels.center().g, 1e-3f) << (sun ? "sun" : "point");
  }
}

// B bounces of a closed box whose walls emit E and reflect rho: E (1 - rho^(B+1)) / (1 - rho). Emission seen by a
// direction is the first bounce; further ones come from the screen, so the camera stands in a corner and sees most.
TEST(IndirectLight, FirstBounceInAClosedEmissiveBox) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f), glm::vec3(2.0f))));
  const Pixels pixels = render(maker.take(), look_at({0, 0, 0.9f}, {0, 0, -1}, 1.2f), thesis_settings(1));
  expect_near_relative(pixels.mean().g, 2.0f * (1.0f + 0.6f), 1e-3f);
}

TEST(IndirectLight, AWhiteSkyOnALambertPlaneGivesItsAlbedo) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert({0.8f, 0.5f, 0.2f})));
  Scene scene = maker.take();
  scene.environment.zenith_radiance = scene.environment.horizon_radiance = scene.environment.ground_radiance =
      glm::vec3(1.0f);
  const Pixels pixels = render(scene, look_at({0, 3, 0.1f}, {0, 0, 0}), thesis_settings(1));
  for (int channel = 0; channel < 3; ++channel)
    expect_near_relative(pixels.center()[channel], glm::vec3(0.8f, 0.5f, 0.2f)[channel], 1e-3f);
}

// A unit square that emits, 1 m above a point: four times the form factor of a quarter seen from under its corner,
// 1 / (2 pi) * 2 a / sqrt(1 + a^2) * atan(a / sqrt(1 + a^2)) with a = 1/2.
TEST(IndirectLight, SquareLightOverAPointHasItsFormFactor) {
  SceneMaker maker;
  maker.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, maker.material(lambert(glm::vec3(0.5f))));
  const int light = maker.material(lambert(glm::vec3(0.0f), glm::vec3(4.0f)));
  maker.quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, light);  // faces down
  Settings settings = thesis_settings(1);
  settings.samples = 1024;
  const Pixels pixels = render(maker.take(), look_at({0, 0.5f, 2.5f}, {0, 0, 0}, 0.02f), settings);
  const float a = 0.5f, s = std::sqrt(1.0f + a * a);
  const float form_factor = 4.0f / (2.0f * kPi) * 2.0f * (a / s) * std::atan(a / s);
  expect_near_relative(pixels.mean().g, 0.5f * 4.0f * form_factor, 0.02f);
}

// Two facing planes, so that no hit is near its pixel: there 1/r^2 has no finite mean.
TEST(IndirectLight, CorrectedEstimatorIsScaleInvariantAndLiteralFallsWithTheSquare) {
  const auto mean_indirect = [](float scale, Estimator estimator) {
    SceneMaker maker;
    const int grey = maker.material(lambert(glm::vec3(0.6f)));
    maker.quad(glm::vec3(-4, 0, 4) * scale, glm::vec3(8, 0, 0) * scale, glm::vec3(0, 0, -8) * scale, grey);
    maker.quad(glm::vec3(-4, 2, -4) * scale, glm::vec3(8, 0, 0) * scale, glm::vec3(0, 0, 8) * scale, grey);
    maker.spot(glm::vec3(0, 1, 0) * scale, {0, 1, 0}, 5.0f * scale * scale, 0.7f);  // lights the upper one
    Settings settings = thesis_settings(1);
    settings.view = ViewKind::kIndirect;
    settings.estimator = estimator;
    PlacedCamera camera = look_at(glm::vec3(0, 1.5f, 1.5f) * scale, glm::vec3(0.0f), 0.5f);
    camera.camera.znear *= scale;
    return render(maker.take(), camera, settings).mean().g;
  };
  const float corrected = mean_indirect(1.0f, Estimator::kCorrected);
  EXPECT_GT(corrected, 0.0f);
  expect_near_relative(mean_indirect(10.0f, Estimator::kCorrected), corrected, 5e-3f);
  const float literal = mean_indirect(1.0f, Estimator::kLiteral);
  EXPECT_GT(literal, 0.0f);
  expect_near_relative(mean_indirect(10.0f, Estimator::kLiteral), literal / 100.0f, 5e-3f);
}

// Hits behind the camera light bounce 1, so it is no screen-space effect; bounce 2 comes from the
// screen and never sees them.
TEST(IndirectLight, ARedWallBehindTheCameraTintsTheFirstBounceOnly) {
  const auto tint = [](int bounces) {
    SceneMaker maker;
    const int white = maker.material(lambert(glm::vec3(0.7f)));
    const int red = maker.material(lambert({0.7f, 0.0f, 0.0f}));
    maker.quad({-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, white);  // in front of the camera, facing it
    maker.quad({-2, -2, 2}, {0, 4, 0}, {4, 0, 0}, red);     // behind it, facing the white wall
    maker.spot({0, 0, 1.0f}, {0, 0, 1}, 20.0f, 0.9f);       // lights the red wall alone
    Settings settings = thesis_settings(bounces);
    settings.view = ViewKind::kIndirect;
    settings.samples = 256;
    return render(maker.take(), look_at({0, 0, 0.5f}, {0, 0, -2}, 0.8f), settings).mean();
  };
  const glm::vec3 first = tint(1), second = tint(2);
  EXPECT_GT(first.r, 0.01f);
  EXPECT_LT(first.g, 1e-4f);
  expect_near_relative(second.r, first.r, 1e-4f);
}

TEST(IndirectLight, AHitInShadowContributesNothing) {
  SceneMaker maker;
  const int grey = maker.material(lambert(glm::vec3(0.7f)));
  maker.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);     // floor
  maker.quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, grey);     // back wall
  maker.quad({-3, 3.1f, -3}, {6, 0, 0}, {0, 0, 6}, grey);  // a roof, facing down: keeps the sun out of it all
  maker.directional({0, -1, 0.01f}, 100.0f);
  Settings settings = thesis_settings(1);
  settings.view = ViewKind::kIndirect;
  const Pixels pixels = render(maker.take(), look_at({0, 1.5f, 1.9f}, {0, 0.5f, -2}, 0.6f), settings);
  EXPECT_LT(pixels.mean().g, 0.02f);  // against 100 * 0.7 / pi * 0.7 = 15 without the roof
}

TEST(IndirectLight, TheIndirectSizeChangesInterpolationAlone) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f))));
  maker.point({0.2f, 0.3f, 0.1f}, 3.0f);
  const Scene scene = maker.take();
  const auto mean = [&](int indirect_size) {
    Settings settings = thesis_settings(1);
    settings.indirect_size = indirect_size;
    settings.samples = 256;
    return render(scene, look_at({0, 0, 0.9f}, {0, 0, -1}, 1.0f), settings, {64, 64}).mean().g;
  };
  expect_near_relative(mean(16), mean(64), 0.02f);
  expect_near_relative(mean(32), mean(64), 0.02f);
}

TEST(Frames, TheSameRequestAndSeedGiveTheSameBytes) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f))));
  maker.point({0.2f, 0.3f, 0.1f}, 3.0f);
  const Scene scene = maker.take();
  const auto once = [&](std::uint32_t seed) {
    Settings settings = thesis_settings(2);
    settings.seed = seed;
    return render(scene, look_at({0, 0, 0.9f}, {0, 0, -1}, 1.0f), settings).rgb;
  };
  const auto first = once(7);
  EXPECT_EQ(once(7), first);
  EXPECT_NE(once(8), first);
}

TEST(Frames, AccumulatedFramesConverge) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f))));
  maker.point({0.2f, 0.3f, 0.1f}, 3.0f);
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 0, 0.9f}, {0, 0, -1}, 1.0f);
  Settings settings = thesis_settings(1);
  settings.view = ViewKind::kIndirect;
  settings.samples = 4;
  settings.indirect_size = 64;
  const auto error_of = [&](const Pixels& pixels, const Pixels& truth) {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.rgb.size(); ++i) sum += std::pow(pixels.rgb[i] - truth.rgb[i], 2.0);
    return sum;
  };
  const Pixels truth = render(scene, camera, settings, {32, 32}, 128);
  const double one = error_of(render(scene, camera, settings, {32, 32}, 1), truth);
  const double sixteen = error_of(render(scene, camera, settings, {32, 32}, 16), truth);
  EXPECT_LT(sixteen, one / 8.0);
}

TEST(Frames, ExposureFollowsTheLightInSecondsNotInFrames) {
  SceneMaker maker;
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(lambert(glm::vec3(0.5f))));
  maker.directional({0, 0, -1}, 1.0f);
  const Scene dim = maker.take();
  Scene bright = dim;
  bright.lights[0].intensity = 64.0f;
  const auto exposure_after_a_second = [&](int frames) {
    Renderer& renderer = shared_renderer();
    const auto view = renderer.make_view();
    FrameRequest request;
    request.camera = look_at({0, 0, 1}, {0, 0, 0});
    request.size_px = {16, 16};
    request.settings = thesis_settings(0);
    request.settings.exposure_ev.reset();
    float exposure_ev = renderer.render(dim, request, *view)->exposure_ev;
    for (int i = 1; i <= frames; ++i) {
      request.time_s = static_cast<double>(i) / frames;
      exposure_ev = renderer.render(bright, request, *view)->exposure_ev;
    }
    return exposure_ev;
  };
  const float at_two = exposure_after_a_second(2), at_twenty = exposure_after_a_second(20);
  EXPECT_NEAR(at_two, at_twenty, 0.05f);
  EXPECT_NEAR(at_twenty, std::log2(0.22f / (64.0f * 0.5f / 3.14159f)) + 6.0f * std::exp(-2.5f), 0.15f);
}

TEST(Frames, BadSettingsAreRefusedByName) {
  Settings settings;
  settings.samples = 0;
  const Status status = check_settings(settings, {64, 64});
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().where, "samples");
}

TEST(Frames, AnEmptySceneShowsItsBackground) {
  Settings settings = thesis_settings(1);
  settings.background = glm::vec3(0.25f, 0.5f, 0.75f);
  const Pixels pixels = render(Scene{}, look_at({0, 0, 1}, {0, 0, 0}), settings, {16, 16});
  EXPECT_EQ(pixels.center(), glm::vec3(0.25f, 0.5f, 0.75f));
}

TEST(Frames, ADegenerateTriangleGivesAWellDefinedPicture) {
  SceneMaker maker;
  maker.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, maker.material(lambert(glm::vec3(0.5f))));
  Scene scene = maker.take();
  auto mesh = std::make_shared<Mesh>(*scene.meshes[0]);
  mesh->primitives[0].positions.assign(4, glm::vec3(0.0f));
  scene.meshes[0] = mesh;
  render(scene, look_at({0, 0, 1}, {0, 0, 0}), thesis_settings(1), {16, 16});
}

}  // namespace
}  // namespace lightwell::testing
