// Errors of linear light, pixel by pixel.
#pragma once

#include <array>

#include "renderer/image_metrics/picture.h"

namespace lightwell::metrics {

/// All over the linear values of two comparable pictures.
struct LinearErrors {
  /// Mean over pixels and channels of (test - reference)^2 / (reference^2 + 0.01), both pictures scaled so that the
  /// reference's mean over all values is 1 (a reference without light keeps its scale).
  double rel_mse = 0.0;
  /// The same without the worst 0.1 % of the pixels (rounded up): the error beside its fireflies.
  double rel_mse_trimmed = 0.0;
  double mse = 0.0;                           // mean of (test - reference)^2, in the pictures' own unit
  std::array<double, 3> mean_signed_error{};  // mean of (test - reference) per channel: positive is too bright
  std::array<double, 3> reference_mean{};
};

LinearErrors linear_errors(const Picture& test, const Picture& reference);

}  // namespace lightwell::metrics
