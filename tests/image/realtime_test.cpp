// The realtime method against closed forms and against `reference`: light and the radiance cache.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(RealtimeDirectLight, LambertPlaneUnderOneLuxHasRadianceAlbedoOverPi) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
  maker.directional({0, -1, 0}, 1.0f);
  const Pixels pixels = render(maker.take(), look_at({0, 3, 0.1f}, {0, 0, 0}), realtime_settings(0));
  EXPECT_NEAR(pixels.center().g, 0.5 / kPi, 1e-4);
}

// Six lights are more than have rays of their own: candidates are drawn from the weaker ones.
TEST(RealtimeDirectLight, FewAndManyLightsAddUp) {
  for (const int copies : {1, 3}) {
    SceneMaker maker;
    maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
    for (int i = 0; i < copies; ++i) {
      maker.point({0, 1, 0}, 1.0f / static_cast<float>(copies));
      maker.directional({0, -1, 0}, 3.0f / static_cast<float>(copies));
    }
    Film film(look_at({0, 3, 0.1f}, {0, 0, 0}, 0.005f), realtime_settings(0));
    EXPECT_NEAR(film.mean_after(maker.take(), 0, 8).g, 0.5 / kPi * 4.0, 0.01 * 0.5 / kPi * 4.0) << copies;
  }
}

TEST(RealtimeDirectLight, ASquareLampHasItsFormFactor) {
  SceneMaker maker;
  maker.quad({0, 0, 1}, {1, 0, 0}, {0, 0, -1}, maker.material(lambert(glm::vec3(1.0f))));
  maker.quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, maker.material(lambert(glm::vec3(0.0f), glm::vec3(1.0f))));
  Film film(look_parallel({0.5f, 0.5f, 0.5f}, {0.5f, 0, 0.5f}, 1.0f), realtime_settings(1));
  EXPECT_NEAR(film.mean_after(maker.take(), 32, 8).g, 0.199825, 0.005 * 0.199825);
}

TEST(RealtimeEnvironment, AConvexBodyUnderAWhiteSkyHasItsAlbedo) {
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 1.0f, 16, false, maker.material(lambert(glm::vec3(0.6f))));
  Scene scene = maker.take();
  scene.environment.zenith_radiance = scene.environment.horizon_radiance = scene.environment.ground_radiance =
      glm::vec3(1.0f);
  Film film(look_at({0, 0, 4}, {0, 0, 0}, 0.2f), realtime_settings(3));
  EXPECT_NEAR(film.mean_after(scene, 0, 2).g, 0.6, 0.002);
}

// All pixels have the same light. With white noise the means of so many texels differ by 1.4 %.
TEST(RealtimeEnvironment, TheNoiseOfAFirstFrameIsBlue) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
  Scene scene = maker.take();
  scene.environment.zenith_radiance = glm::vec3(1.0f);
  scene.environment.horizon_radiance = scene.environment.ground_radiance = glm::vec3(0.0f);
  Settings settings = realtime_settings(1);
  settings.samples = 16;  // one ray
  settings.indirect_size = 128;
  Film film(look_parallel({0, 3, 0}, {0, 0, 0.01f}, 4.0f), settings, {128, 128});
  const Pixels pixels = film.next(scene);
  const float mean = pixels.mean().g;
  double error = 0.0;
  for (int corner = 0; corner < 256; ++corner) {
    float sum = 0.0f;
    for (int i = 0; i < 64; ++i) sum += pixels.at(corner % 16 * 8 + i % 8, corner / 16 * 8 + i / 8).g / 64.0f;
    error += static_cast<double>((sum / mean - 1.0f) * (sum / mean - 1.0f)) / 256.0;
  }
  std::printf("means of 8 x 8 texels differ by %.3f %%\n", 100.0 * std::sqrt(error));
  EXPECT_LT(std::sqrt(error), 0.01);
}

TEST(RealtimeBounces, AClosedEmissiveBoxIsAGeometricSeries) {
  const double emission = 2.0, albedo = 0.6;
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f), glm::vec3(2.0f))));
  const Scene scene = maker.take();
  for (const int bounces : {0, 1, 2, kUnlimitedBounces}) {
    Film film(kInRoom, realtime_settings(bounces));
    const double lost = bounces == kUnlimitedBounces ? 0.0 : std::pow(albedo, bounces + 1);
    const double expected = emission * (1.0 - lost) / (1.0 - albedo);
    EXPECT_NEAR(film.mean_after(scene, bounces > 2 ? 96 : 8, 8).g, expected, 0.01 * expected) << bounces;
  }
}

// No method of the screen can do this: all that is red is behind the camera. From the third bounce on the cache carries
// all that follow.
TEST(RealtimeBounces, ARedWallBehindTheCameraTintsTheWhiteOneInFront) {
  SceneMaker maker;
  const int white = maker.material(lambert(glm::vec3(0.7f)));
  maker.room({-1, -1, -1}, {1, 1, 1.2f}, white);
  maker.quad({1, -1, 1.19f}, {-2, 0, 0}, {0, 2, 0}, maker.material(lambert({0.8f, 0.05f, 0.05f})));
  maker.point({0.2f, 0.3f, 0.4f}, 3.0f);
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 0, 0.8f}, {0, 0, -1}, 0.8f);
  Settings settings = realtime_settings(8);
  settings.samples = 128;
  Film film(camera, settings);
  const glm::vec3 found = film.mean_after(scene, 96, 8);
  const glm::vec3 truth = render(scene, camera, reference_settings(kUnlimitedBounces), {32, 32}, 64).mean();
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(found[channel], truth[channel], 0.02f * truth[channel]) << channel;
  std::printf("red wall: %+.2f %% red, %+.2f %% green\n", 100.0 * static_cast<double>(found.r / truth.r - 1.0f),
              100.0 * static_cast<double>(found.g / truth.g - 1.0f));
}

// Two rooms that share a floor, a ceiling and a back wall, open to the front, so that the cache has cells in both; the
// lamp is in one, and nothing of its light can come to the other.
TEST(RealtimeCache, AThinWallDoesNotLeak) {
  SceneMaker maker;
  const int white = maker.material(lambert(glm::vec3(0.7f)));
  maker.quad({-2, -1, 1}, {4, 0, 0}, {0, 0, -2}, white);
  maker.quad({-2, 1, -1}, {4, 0, 0}, {0, 0, 2}, white);
  maker.quad({-2, -1, -1}, {4, 0, 0}, {0, 2, 0}, white);
  maker.quad({-2, -1, 1}, {0, 0, -2}, {0, 2, 0}, white);
  maker.quad({2, -1, -1}, {0, 0, 2}, {0, 2, 0}, white);
  maker.quad({-0.005f, -1, -1}, {0, 0, 2}, {0, 2, 0}, white);
  maker.quad({0.005f, -1, 1}, {0, 0, -2}, {0, 2, 0}, white);
  maker.point({1.0f, 0.2f, 0.0f}, 3.0f);
  const Scene scene = maker.take();
  Settings settings = realtime_settings(8);
  settings.indirect_size = 64;
  Film film(look_at({0, 0, 4}, {0, 0, 0}, 0.7f), settings, {64, 32});
  for (int i = 0; i < 40; ++i) film.next(scene);
  const Pixels pixels = film.next(scene);
  float dark = 0.0f, bright = 0.0f;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      dark += pixels.at(x, y).g;
      bright += pixels.at(63 - x, y).g;
    }
  std::printf("dark room / bright room: %.5f\n", static_cast<double>(dark / bright));
  EXPECT_LT(dark, 0.01f * bright);
}

// Half a million rays in four milliseconds: where a device does that, nothing has to be given up.
TEST(RealtimeBudget, GivesUpRaysForTheRate) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f), glm::vec3(1.0f))));
  const Scene scene = maker.take();
  FrameRequest request;
  request.camera = kInRoom;
  request.size_px = {64, 64};
  request.settings = realtime_settings(1);
  request.settings.samples = 1024;
  request.settings.indirect_size = 64;
  request.settings.target_fps = 240;
  const auto view = shared_renderer().make_view();
  std::uint64_t first_rays = 0;
  for (int frame = 0; frame < 12; ++frame) {
    const Result<Frame> made = shared_renderer().render(scene, request, *view);
    ASSERT_TRUE(made.ok());
    if (frame == 0) first_rays = made->rays;
    if (frame == 11) {
      EXPECT_TRUE(made->rays < first_rays || made->total_ms < 1000.0 / 240.0) << made->rays;
    }
  }
}

}  // namespace
}  // namespace lightwell::testing
