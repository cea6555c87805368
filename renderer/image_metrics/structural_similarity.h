// SSIM: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity",
// IEEE Transactions on Image Processing 13(4), 2004.
#pragma once

#include <optional>

#include "renderer/image_metrics/picture.h"

namespace lightwell::metrics {

/// Mean SSIM of two displayed pictures (linear, 0..1) of one size: on their sRGB-encoded luma (BT.601 weights), with
/// the paper's 11x11 Gaussian of deviation 1.5, K1 = 0.01, K2 = 0.03, over the windows that lie inside the picture. 1
/// for equal pictures, down to -1. None if a side is shorter than a window.
std::optional<double> structural_similarity(const Picture& test, const Picture& reference);

}  // namespace lightwell::metrics
