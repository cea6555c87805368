#include "renderer/image_metrics/convolve.h"

#include <algorithm>
#include <cmath>

namespace lightwell::metrics {

namespace {

// One tap at a time over a whole row, which compilers turn into SIMD code.
void add_scaled(float weight, const float* in, float* out, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) out[i] += weight * in[i];
}

Plane convolve_rows(const Plane& plane, std::span<const float> kernel) {
  const std::size_t width = static_cast<std::size_t>(plane.width);
  const std::size_t radius = kernel.size() / 2;
  Plane result(plane.width, plane.height);
  std::vector<float> padded(width + 2 * radius);
  for (std::size_t begin = 0; begin < plane.values.size(); begin += width) {
    const float* row = plane.values.data() + begin;
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, row[width - 1]);
    for (std::size_t tap = 0; tap < kernel.size(); ++tap)
      add_scaled(kernel[tap], padded.data() + tap, result.values.data() + begin, width);
  }
  return result;
}

Plane convolve_columns(const Plane& plane, std::span<const float> kernel) {
  const std::size_t width = static_cast<std::size_t>(plane.width);
  const int radius = static_cast<int>(kernel.size() / 2);
  Plane result(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y) {
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const int source = std::clamp(y + static_cast<int>(tap) - radius, 0, plane.height - 1);
      add_scaled(kernel[tap], plane.values.data() + static_cast<std::size_t>(source) * width,
                 result.values.data() + static_cast<std::size_t>(y) * width, width);
    }
  }
  return result;
}

}  // namespace

std::vector<float> gaussian_kernel(int radius, double sigma) {
  std::vector<double> weights;
  double sum = 0.0;
  for (int x = -radius; x <= radius; ++x) {
    weights.push_back(std::exp(-static_cast<double>(x) * x / (2.0 * sigma * sigma)));
    sum += weights.back();
  }
  std::vector<float> kernel;
  for (const double weight : weights) kernel.push_back(static_cast<float>(weight / sum));
  return kernel;
}

Plane convolve(const Plane& plane, std::span<const float> row, std::span<const float> column) {
  return convolve_columns(convolve_rows(plane, row), column);
}

}  // namespace lightwell::metrics
