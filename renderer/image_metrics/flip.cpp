// One pass over two pictures: what the eye's contrast sensitivity lets through is compared in colour; edges and points
// are compared in luma; where those differ, the colour difference is raised towards 1.
#include "renderer/image_metrics/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/image_metrics/convolve.h"
#include "renderer/image_metrics/flip_color.h"

namespace lightwell::metrics {

namespace {

constexpr double kPi = std::numbers::pi;

// The papers' constants: exponents of colour and feature differences, the split of the colour difference's range, the
// width of the features in degrees.
constexpr double kColorExponent = 0.7;
constexpr double kFeatureExponent = 0.5;
constexpr double kSplitDifference = 0.4;
constexpr double kSplitError = 0.95;
constexpr double kFeatureWidthDegrees = 0.082;

// Contrast sensitivity of one opponent channel as a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Sensitivity {
  struct Term {
    double a, b;
  };
  std::array<Term, 2> terms;
};
constexpr std::array<Sensitivity, 3> kSensitivities = {Sensitivity{{{{1.0, 0.0047}, {0.0, 0.00001}}}},
                                                       Sensitivity{{{{1.0, 0.0053}, {0.0, 0.00001}}}},
                                                       Sensitivity{{{{34.1, 0.04}, {13.5, 0.025}}}}};
constexpr double kWidestTerm = 0.04;

using Planes = std::array<Plane, 3>;

Color color_at(const Planes& planes, std::size_t pixel) {
  return {planes[0].values[pixel], planes[1].values[pixel], planes[2].values[pixel]};
}

Color color_at(const Picture& picture, std::size_t pixel) {
  return {picture.rgb[3 * pixel], picture.rgb[3 * pixel + 1], picture.rgb[3 * pixel + 2]};
}

Planes opponent_planes(const Picture& picture) {
  Planes planes;
  planes.fill(Plane(picture.width, picture.height));
  for (std::size_t pixel = 0; pixel < picture.pixel_count(); ++pixel) {
    const Color color = ycxcz_from_linear(color_at(picture, pixel));
    for (std::size_t channel = 0; channel < 3; ++channel)
      planes[channel].values[pixel] = static_cast<float>(color[channel]);
  }
  return planes;
}

// Each term is a product of a row and a column, so that the sum needs two convolutions at most.
Plane filter_by_sensitivity(const Plane& plane, const Sensitivity& sensitivity, double pixels_per_degree) {
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidestTerm / (2.0 * kPi * kPi)) * pixels_per_degree));
  Plane result(plane.width, plane.height);
  double total_weight = 0.0;
  for (const Sensitivity::Term& term : sensitivity.terms) {
    if (term.a == 0.0) continue;
    std::vector<float> kernel;
    double sum = 0.0;
    for (int x = -radius; x <= radius; ++x) {
      const double degrees = x / pixels_per_degree;
      const double value = std::exp(-kPi * kPi * degrees * degrees / term.b);
      kernel.push_back(static_cast<float>(value));
      sum += value;
    }
    const double weight = term.a * std::sqrt(kPi / term.b);
    total_weight += weight * sum * sum;
    const Plane filtered = convolve(plane, kernel, kernel);
    for (std::size_t i = 0; i < result.values.size(); ++i)
      result.values[i] += static_cast<float>(weight) * filtered.values[i];
  }
  for (float& value : result.values) value /= static_cast<float>(total_weight);
  return result;
}

Planes filtered_planes(const Planes& planes, double pixels_per_degree) {
  Planes filtered;
  for (std::size_t channel = 0; channel < 3; ++channel)
    filtered[channel] = filter_by_sensitivity(planes[channel], kSensitivities[channel], pixels_per_degree);
  return filtered;
}

Color perceived(const Planes& filtered, std::size_t pixel) {
  Color rgb = linear_from_ycxcz(color_at(filtered, pixel));
  for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
  return hunt_lab_from_linear(rgb);
}

// HyAB to 0..1: differences up to the split share most of the range; the greatest is that of green and blue.
double color_error(double difference) {
  static const double greatest =
      std::pow(hyab(hunt_lab_from_linear({0.0, 1.0, 0.0}), hunt_lab_from_linear({0.0, 0.0, 1.0})), kColorExponent);
  const double split = kSplitDifference * greatest;
  const double raised = std::pow(difference, kColorExponent);
  if (raised < split) return kSplitError / split * raised;
  return kSplitError + (raised - split) / (greatest - split) * (1.0 - kSplitError);
}

// A derivative of a Gaussian whose positive and negative weights each sum to 1.
template <class Factor>
std::vector<float> derivative_kernel(int radius, double deviation, Factor factor) {
  std::vector<double> weights;
  double positive = 0.0, negative = 0.0;
  for (int x = -radius; x <= radius; ++x) {
    weights.push_back(factor(x) * std::exp(-static_cast<double>(x) * x / (2.0 * deviation * deviation)));
    (weights.back() > 0.0 ? positive : negative) += std::abs(weights.back());
  }
  std::vector<float> kernel;
  for (const double weight : weights)
    kernel.push_back(static_cast<float>(weight / (weight > 0.0 ? positive : negative)));
  return kernel;
}

struct Features {
  Plane edges, points;  // magnitudes
};

Features features_of(const Plane& opponent_luma, double pixels_per_degree) {
  const double deviation = 0.5 * kFeatureWidthDegrees * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3.0 * deviation));
  const std::vector<float> smooth = gaussian_kernel(radius, deviation);
  const auto magnitude = [&](const std::vector<float>& kernel, const Plane& luma) {
    Plane result = convolve(luma, kernel, smooth);
    const Plane other = convolve(luma, smooth, kernel);
    for (std::size_t i = 0; i < result.values.size(); ++i)
      result.values[i] = std::hypot(result.values[i], other.values[i]);
    return result;
  };
  Plane luma = opponent_luma;
  for (float& value : luma.values) value = (value + 16.0f) / 116.0f;
  const double variance = deviation * deviation;
  return {magnitude(derivative_kernel(radius, deviation, [](int x) { return -static_cast<double>(x); }), luma),
          magnitude(derivative_kernel(radius, deviation, [=](int x) { return x * x / variance - 1.0; }), luma)};
}

double feature_error(const Features& test, const Features& reference, std::size_t pixel) {
  const double edge = std::abs(test.edges.values[pixel] - reference.edges.values[pixel]);
  const double point = std::abs(test.points.values[pixel] - reference.points.values[pixel]);
  return std::min(std::pow(std::max(edge, point) / std::numbers::sqrt2, kFeatureExponent), 1.0);
}

// The ACES curve as Narkowicz fitted it, with the 0.6 that takes off its usual pre-exposure.
struct AcesCurve {
  double a2 = 0.36 * 2.51, a1 = 0.6 * 0.03;
  double b2 = 0.36 * 2.43, b1 = 0.6 * 0.59, b0 = 0.14;

  double operator()(double x) const { return (a2 * x * x + a1 * x) / (b2 * x * x + b1 * x + b0); }
  /// The positive x whose value is y.
  double inverse(double y) const {
    const double a = a2 - y * b2, half_b = 0.5 * (a1 - y * b1), c = -y * b0;
    return (-half_b + std::sqrt(half_b * half_b - a * c)) / a;
  }
};

Picture under_aces(const Picture& picture, double stops) {
  Picture shown = picture;
  shown.display_referred = true;
  const double scale = std::exp2(stops);
  for (float& value : shown.rgb)
    value = static_cast<float>(std::clamp(AcesCurve{}(std::max(scale * static_cast<double>(value), 0.0)), 0.0, 1.0));
  return shown;
}

}  // namespace

Plane ldr_flip(const Picture& test, const Picture& reference, double pixels_per_degree) {
  const Planes test_planes = opponent_planes(test), reference_planes = opponent_planes(reference);
  const Planes test_filtered = filtered_planes(test_planes, pixels_per_degree);
  const Planes reference_filtered = filtered_planes(reference_planes, pixels_per_degree);
  const Features test_features = features_of(test_planes[0], pixels_per_degree);
  const Features reference_features = features_of(reference_planes[0], pixels_per_degree);
  Plane errors(reference.width, reference.height);
  for (std::size_t pixel = 0; pixel < errors.values.size(); ++pixel) {
    const double color = color_error(hyab(perceived(test_filtered, pixel), perceived(reference_filtered, pixel)));
    const double feature = feature_error(test_features, reference_features, pixel);
    errors.values[pixel] = static_cast<float>(std::pow(color, 1.0 - feature));
  }
  return errors;
}

ExposureRange exposure_range(const Picture& reference) {
  constexpr double kBright = 0.85;
  constexpr double kMostStops = 24.0;
  std::vector<double> luminances(reference.pixel_count());
  for (std::size_t pixel = 0; pixel < luminances.size(); ++pixel) {
    const Color color = color_at(reference, pixel);
    luminances[pixel] = luminance(color[0], color[1], color[2]);
  }
  const double brightest = *std::max_element(luminances.begin(), luminances.end());
  if (brightest <= 0.0) return {};
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double median = std::max(*middle, brightest * std::exp2(-kMostStops));
  const double wanted = AcesCurve{}.inverse(kBright);
  ExposureRange range{std::log2(wanted / brightest), std::log2(wanted / median), 2};
  range.count = std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
  return range;
}

Plane hdr_flip(const Picture& test, const Picture& reference, const ExposureRange& range, double pixels_per_degree) {
  Plane worst(reference.width, reference.height);
  for (int i = 0; i < range.count; ++i) {
    const double step = range.count > 1 ? (range.stop - range.start) / (range.count - 1) : 0.0;
    const double stops = range.start + i * step;
    const Plane errors = ldr_flip(under_aces(test, stops), under_aces(reference, stops), pixels_per_degree);
    for (std::size_t pixel = 0; pixel < worst.values.size(); ++pixel)
      worst.values[pixel] = std::max(worst.values[pixel], errors.values[pixel]);
  }
  return worst;
}

}  // namespace lightwell::metrics
