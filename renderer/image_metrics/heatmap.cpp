#include "renderer/image_metrics/heatmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/image_metrics/display.h"

namespace lightwell::metrics {

namespace {

std::array<double, 3> linear_from_oklab(double lightness, double a, double b) {
  const auto cubed = [](double x) { return x * x * x; };
  const double l = cubed(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cubed(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cubed(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool is_displayable(const std::array<double, 3>& linear) {
  return std::all_of(linear.begin(), linear.end(), [](double value) { return value >= 0.0 && value <= 1.0; });
}

}  // namespace

std::array<std::uint8_t, 3> heat_color(double value) {
  constexpr double kTopLightness = 0.97;
  constexpr double kFirstHueDegrees = 290.0;  // violet
  constexpr double kHueTurnDegrees = 175.0;   // through red to yellow
  constexpr double kMostChroma = 0.15;
  const double t = std::isnan(value) ? 1.0 : std::clamp(value, 0.0, 1.0);
  const double hue = (kFirstHueDegrees + kHueTurnDegrees * t) * std::numbers::pi / 180.0;
  // As much chroma as the curve asks for, less where sRGB has no such colour: lightness and hue stay.
  double chroma = kMostChroma * std::sin(std::numbers::pi * std::pow(t, 0.9)) + 0.05 * t;
  std::array<double, 3> linear = linear_from_oklab(kTopLightness * t, 0.0, 0.0);
  for (; chroma > 0.0; chroma -= 0.002) {
    const std::array<double, 3> wanted =
        linear_from_oklab(kTopLightness * t, chroma * std::cos(hue), chroma * std::sin(hue));
    if (!is_displayable(wanted)) continue;
    linear = wanted;
    break;
  }
  std::array<std::uint8_t, 3> color;
  for (std::size_t channel = 0; channel < 3; ++channel)
    color[channel] = static_cast<std::uint8_t>(std::lround(255.0 * srgb_from_linear(linear[channel])));
  return color;
}

std::vector<std::uint8_t> heatmap(const Plane& errors) {
  std::array<std::array<std::uint8_t, 3>, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = heat_color(static_cast<double>(i) / 255.0);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(errors.values.size() * 3);
  for (const float error : errors.values) {
    const double clamped = std::isnan(error) ? 1.0 : std::clamp(static_cast<double>(error), 0.0, 1.0);
    const std::array<std::uint8_t, 3>& color = table[static_cast<std::size_t>(std::lround(255.0 * clamped))];
    rgb.insert(rgb.end(), color.begin(), color.end());
  }
  return rgb;
}

}  // namespace lightwell::metrics
