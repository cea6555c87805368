// Pictures of the reference method over their samples: the same for the same seed, without drift, and with an error
// that falls as it must.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/image/estimate.h"
#include "tests/image/reference_scenes.h"

namespace lightwell::testing {
namespace {

TEST(ReferenceFrames, TheSameSeedGivesTheSameBytes) {
  const Scene scene = varied_room();
  const PlacedCamera camera = before_varied_room();
  Settings settings = reference_settings(6);
  const auto first = render(scene, camera, settings, {48, 32}, 3).rgb;
  EXPECT_EQ(render(scene, camera, settings, {48, 32}, 3).rgb, first);
  settings.seed = 1;
  EXPECT_NE(render(scene, camera, settings, {48, 32}, 3).rgb, first);
}

TEST(ReferenceFrames, ThousandsOfSamplesKeepTheirMean) {
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 1.0f, 16, false, maker.material(lambert(glm::vec3(0.6f))));
  const Scene scene = with_white_sky(std::move(maker));
  Settings settings = reference_settings(1);
  settings.light_strategy = LightStrategy::kRays;  // every sample is the albedo
  const Pixels pixels = render(scene, look_at({0, 0, 4}, {0, 0, 0}, 0.2f), settings, {4, 4}, 5000);
  for (const float value : pixels.rgb) EXPECT_NEAR(value, 0.6f, 2e-6f);
}

constexpr int kMostSamples = 4096, kLeastSamples = 16;

/// The accumulated picture after every kLeastSamples frames, times the number of frames.
std::vector<std::vector<double>> refined(const Scene& scene, const PlacedCamera& camera, std::uint32_t seed) {
  Renderer& renderer = shared_renderer();
  const auto view = renderer.make_view();
  FrameRequest request;
  request.camera = camera;
  request.size_px = {16, 16};
  request.settings = reference_settings(4);
  request.settings.seed = seed;
  request.accumulate = true;
  request.want_display = false;
  std::vector<std::vector<double>> sums(1, std::vector<double>(3 * 16 * 16, 0.0));
  for (int frame = 1; frame <= kMostSamples; ++frame) {
    request.want_linear = frame % kLeastSamples == 0;
    const Result<Frame> result = renderer.render(scene, request, *view);
    EXPECT_TRUE(result.ok());
    if (!request.want_linear) continue;
    sums.emplace_back(result->linear_rgb.begin(), result->linear_rgb.end());
    for (double& value : sums.back()) value *= frame;
  }
  return sums;
}

/// relMSE of `samples` paths a pixel, from the difference of two independent runs: it needs no truth, whose own noise
/// would hide how the error goes on falling. Of each run all aligned blocks of its samples are taken, which are Sobol
/// points as good as the first: few pixels with much light that is hard to find make the most of the error of few
/// samples, and a single block may not show them.
double rel_mse(const std::vector<std::vector<double>>& one, const std::vector<std::vector<double>>& other,
               int samples) {
  const std::size_t texels = one[0].size(), step = static_cast<std::size_t>(samples / kLeastSamples);
  const double whole = 2.0 * kMostSamples;
  double mean = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < texels; ++i)
    mean += (one.back()[i] + other.back()[i]) / (whole * static_cast<double>(texels));
  std::size_t blocks = 0;
  for (std::size_t begin = 0; begin + step < one.size(); begin += step, ++blocks)
    for (std::size_t i = 0; i < texels; ++i) {
      const double a = one[begin + step][i] - one[begin][i], b = other[begin + step][i] - other[begin][i];
      const double value = (one.back()[i] + other.back()[i]) / (whole * mean);
      sum += 0.5 * std::pow((a - b) / (samples * mean), 2.0) / (value * value + 0.01);
    }
  return sum / static_cast<double>(texels * blocks);
}

/// The exponent of N in the error, by least squares over 16, 64, ... 4096 samples.
double slope_of_error(const char* name, const Scene& scene, const PlacedCamera& camera) {
  const auto one = refined(scene, camera, 1), other = refined(scene, camera, 2);
  std::vector<glm::dvec2> points;
  glm::dvec2 mean(0.0);
  for (int samples = kLeastSamples; samples <= kMostSamples; samples *= 4) {
    const double error = rel_mse(one, other, samples);
    std::printf("%s: %4d samples, relMSE %.6f\n", name, samples, error);
    points.emplace_back(std::log(samples), std::log(error));
    mean += points.back();
  }
  mean /= static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0;
  for (const glm::dvec2& point : points) {
    xx += (point.x - mean.x) * (point.x - mean.x);
    xy += (point.x - mean.x) * (point.y - mean.y);
  }
  std::printf("%s: slope %.3f\n", name, xy / xx);
  return xy / xx;
}

// Steeper where Sobol helps; much steeper would mean that the two pictures are not independent.
constexpr double kLeastSlope = -1.5, kMostSlope = -0.9;

TEST(ReferenceFrames, TheErrorFallsAsOneOverNAmongLambertWalls) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f))));
  maker.quad({-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f},
             maker.material(lambert(glm::vec3(0.0f), glm::vec3(6.0f))));
  maker.point({0.2f, -0.3f, 0.1f}, 0.3f);
  const double slope = slope_of_error("Lambert walls", maker.take(), look_at({0, 0, 0.9f}, {0, 0, -1}, 1.2f));
  EXPECT_LT(slope, kMostSlope);
  EXPECT_GT(slope, kLeastSlope);
}

TEST(ReferenceFrames, TheErrorFallsAsOneOverNOnRoughMetal) {
  const double slope = slope_of_error("rough metal", varied_room(), before_varied_room());
  EXPECT_LT(slope, kMostSlope);
  EXPECT_GT(slope, kLeastSlope);
}

}  // namespace
}  // namespace lightwell::testing
