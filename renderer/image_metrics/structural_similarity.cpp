#include "renderer/image_metrics/structural_similarity.h"

#include "renderer/image_metrics/convolve.h"
#include "renderer/image_metrics/display.h"

namespace lightwell::metrics {

namespace {

constexpr int kWindowRadius = 5;
constexpr double kWindowDeviation = 1.5;
constexpr double kC1 = 0.01 * 0.01;  // (K1 L)^2 with the dynamic range L = 1
constexpr double kC2 = 0.03 * 0.03;

Plane luma_of(const Picture& picture) {
  Plane luma(picture.width, picture.height);
  for (std::size_t pixel = 0; pixel < luma.values.size(); ++pixel) {
    const float* rgb = picture.rgb.data() + 3 * pixel;
    luma.values[pixel] = static_cast<float>(0.299 * srgb_from_linear(rgb[0]) + 0.587 * srgb_from_linear(rgb[1]) +
                                            0.114 * srgb_from_linear(rgb[2]));
  }
  return luma;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result(a.width, a.height);
  for (std::size_t i = 0; i < a.values.size(); ++i) result.values[i] = a.values[i] * b.values[i];
  return result;
}

}  // namespace

std::optional<double> structural_similarity(const Picture& test, const Picture& reference) {
  if (test.width <= 2 * kWindowRadius || test.height <= 2 * kWindowRadius) return std::nullopt;
  const std::vector<float> window = gaussian_kernel(kWindowRadius, kWindowDeviation);
  const Plane x = luma_of(test);
  const Plane y = luma_of(reference);
  const Plane mean_x = convolve(x, window, window);
  const Plane mean_y = convolve(y, window, window);
  const Plane mean_xx = convolve(product(x, x), window, window);
  const Plane mean_yy = convolve(product(y, y), window, window);
  const Plane mean_xy = convolve(product(x, y), window, window);

  double sum = 0.0;
  for (int row = kWindowRadius; row < x.height - kWindowRadius; ++row) {
    for (int column = kWindowRadius; column < x.width - kWindowRadius; ++column) {
      const std::size_t i =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(x.width) + static_cast<std::size_t>(column);
      const double mx = mean_x.values[i], my = mean_y.values[i];
      const double variance_x = mean_xx.values[i] - mx * mx;
      const double variance_y = mean_yy.values[i] - my * my;
      const double covariance = mean_xy.values[i] - mx * my;
      sum += (2.0 * mx * my + kC1) * (2.0 * covariance + kC2) /
             ((mx * mx + my * my + kC1) * (variance_x + variance_y + kC2));
    }
  }
  return sum / (static_cast<double>(x.width - 2 * kWindowRadius) * static_cast<double>(x.height - 2 * kWindowRadius));
}

}  // namespace lightwell::metrics
