#include "renderer/image_metrics/error_measures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace lightwell::metrics {

namespace {

constexpr double kRelativeEpsilon = 0.01;   // of the squared reference whose mean is 1
constexpr double kTrimmedFraction = 0.001;  // of the pixels

double scale_to_mean_one(const Picture& reference) {
  const double sum = std::accumulate(reference.rgb.begin(), reference.rgb.end(), 0.0);
  const double mean = sum / static_cast<double>(reference.rgb.size());
  return mean > 0.0 ? 1.0 / mean : 1.0;
}

// Of each pixel, the mean over its channels.
std::vector<double> relative_errors(const Picture& test, const Picture& reference) {
  const double scale = scale_to_mean_one(reference);
  std::vector<double> errors(reference.pixel_count());
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    const double wanted = scale * static_cast<double>(reference.rgb[i]);
    const double difference = scale * static_cast<double>(test.rgb[i]) - wanted;
    errors[i / 3] += difference * difference / (wanted * wanted + kRelativeEpsilon) / 3.0;
  }
  return errors;
}

double mean_without_worst(std::vector<double> errors, std::size_t dropped) {
  const auto end = errors.end() - static_cast<std::ptrdiff_t>(dropped);
  if (end == errors.begin()) return 0.0;
  if (dropped > 0) std::nth_element(errors.begin(), end, errors.end());
  return std::accumulate(errors.begin(), end, 0.0) / static_cast<double>(end - errors.begin());
}

}  // namespace

LinearErrors linear_errors(const Picture& test, const Picture& reference) {
  LinearErrors result;
  const double pixels = static_cast<double>(reference.pixel_count());
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    const double wanted = static_cast<double>(reference.rgb[i]);
    const double difference = static_cast<double>(test.rgb[i]) - wanted;
    result.mse += difference * difference / (3.0 * pixels);
    result.mean_signed_error[i % 3] += difference / pixels;
    result.reference_mean[i % 3] += wanted / pixels;
  }
  const std::vector<double> errors = relative_errors(test, reference);
  result.rel_mse = mean_without_worst(errors, 0);
  result.rel_mse_trimmed = mean_without_worst(errors, static_cast<std::size_t>(std::ceil(pixels * kTrimmedFraction)));
  return result;
}

}  // namespace lightwell::metrics
