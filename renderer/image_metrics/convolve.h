// Convolution of a plane with kernels that are products of a row and a column.
#pragma once

#include <span>
#include <vector>

#include "renderer/image_metrics/picture.h"

namespace lightwell::metrics {

/// exp(-x^2 / (2 sigma^2)) for x in -radius..radius, scaled to the sum 1.
std::vector<float> gaussian_kernel(int radius, double sigma);

/// out(x, y) = sum over i, j of row[i] * column[j] * plane(x + i - r, y + j - s), with r and s half the lengths, which
/// are odd. Beyond the border the nearest texel counts. (The kernel is not mirrored: strictly, a correlation.)
Plane convolve(const Plane& plane, std::span<const float> row, std::span<const float> column);

}  // namespace lightwell::metrics
