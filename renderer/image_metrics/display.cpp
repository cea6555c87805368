#include "renderer/image_metrics/display.h"

#include <algorithm>
#include <cmath>

namespace lightwell::metrics {

namespace {
constexpr double kMiddleGrey = 0.18;
}

double srgb_from_linear(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

double linear_from_srgb(double encoded) {
  const double value = std::clamp(encoded, 0.0, 1.0);
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

std::array<double, 3> neutral_tone_map(std::array<double, 3> linear) {
  constexpr double kFresnel = 0.04;  // what a dielectric reflects is taken off, so that base colours come out as given
  constexpr double kStartCompression = 0.8 - kFresnel;
  constexpr double kDesaturation = 0.15;
  for (double& value : linear) value = std::max(value, 0.0);
  const auto [least, most] = std::minmax({linear[0], linear[1], linear[2]});
  const double offset = least < 2.0 * kFresnel ? least - least * least / (4.0 * kFresnel) : kFresnel;
  const double peak = most - offset;
  for (double& value : linear) value -= offset;
  if (peak < kStartCompression) return linear;
  const double range = 1.0 - kStartCompression;
  const double new_peak = 1.0 - range * range / (peak + range - kStartCompression);
  const double saturated = 1.0 / (kDesaturation * (peak - new_peak) + 1.0);
  for (double& value : linear) value = value * (new_peak / peak) * saturated + new_peak * (1.0 - saturated);
  return linear;
}

double exposure_of(const Picture& reference) {
  if (reference.display_referred) return 1.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.rgb.size(); i += 3)
    sum += luminance(reference.rgb[i], reference.rgb[i + 1], reference.rgb[i + 2]);
  const double mean = sum / static_cast<double>(reference.pixel_count());
  return mean > 0.0 ? kMiddleGrey / mean : 1.0;
}

Picture displayed(const Picture& picture, double exposure) {
  Picture shown = picture;
  shown.display_referred = true;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    std::array<double, 3> color = {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
    if (!picture.display_referred) {
      for (double& value : color) value *= exposure;
      color = neutral_tone_map(color);
    }
    for (std::size_t channel = 0; channel < 3; ++channel)
      shown.rgb[i + channel] = static_cast<float>(std::clamp(color[channel], 0.0, 1.0));
  }
  return shown;
}

}  // namespace lightwell::metrics
