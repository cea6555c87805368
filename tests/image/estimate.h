// The mean of independent renders and how sure it is: what statistical tests judge by.
#pragma once

#include <functional>

#include "tests/image/test_scenes.h"

namespace lightwell::testing {

struct Estimate {
  double mean = 0.0;
  double standard_error = 0.0;
};

/// `value` of `runs` pictures that differ by their seeds alone, each of `spp` accumulated frames.
Estimate estimate(const Scene& scene, const PlacedCamera& camera, Settings settings, glm::ivec2 size_px, int spp,
                  int runs, const std::function<double(const Pixels&)>& value);

/// Of the mean green of all pixels.
Estimate estimate_mean(const Scene& scene, const PlacedCamera& camera, const Settings& settings,
                       glm::ivec2 size_px = {16, 16}, int spp = 16, int runs = 12);

/// Fails where `expected` is more than `sigmas` standard errors away, beyond what is allowed for known reasons (a
/// tessellated sphere is no sphere), and where the estimate says too little: its standard error is over `precision`
/// of what is expected.
void expect_within(const Estimate& estimate, double expected, double allowed = 0.0, double precision = 0.01,
                   double sigmas = 4.0);

}  // namespace lightwell::testing
