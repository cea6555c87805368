#include "tests/image/estimate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lightwell::testing {

namespace {

// Of numbers in single precision: what no variance shows.
constexpr double kRounding = 2e-5;

}  // namespace

Estimate estimate(const Scene& scene, const PlacedCamera& camera, Settings settings, glm::ivec2 size_px, int spp,
                  int runs, const std::function<double(const Pixels&)>& value) {
  double sum = 0.0, squares = 0.0;
  for (int run = 0; run < runs; ++run) {
    settings.seed = 1000 + static_cast<std::uint32_t>(run);
    const double x = value(render(scene, camera, settings, size_px, spp));
    sum += x;
    squares += x * x;
  }
  const double mean = sum / runs;
  const double variance = std::max(0.0, squares / runs - mean * mean) * runs / (runs - 1);
  return {mean, std::sqrt(variance / runs)};
}

Estimate estimate_mean(const Scene& scene, const PlacedCamera& camera, const Settings& settings, glm::ivec2 size_px,
                       int spp, int runs) {
  return estimate(scene, camera, settings, size_px, spp, runs,
                  [](const Pixels& pixels) { return static_cast<double>(pixels.mean().g); });
}

void expect_within(const Estimate& estimate, double expected, double allowed, double precision, double sigmas) {
  EXPECT_LE(estimate.standard_error, precision * std::abs(expected)) << "the estimate says too little";
  EXPECT_NEAR(estimate.mean, expected, sigmas * estimate.standard_error + (allowed + kRounding) * std::abs(expected))
      << "standard error " << estimate.standard_error;
}

}  // namespace lightwell::testing
