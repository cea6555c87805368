// Errors as a picture: a colour map whose lightness rises evenly, so that it reads the same in print and in grey.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/image_metrics/picture.h"

namespace lightwell::metrics {

/// The sRGB colour of `value` (0..1; beyond is clamped, NaN counts as 1): black through violet, red and orange to a
/// pale yellow. It is a curve through Oklab (Ottosson 2020) with lightness proportional to `value`.
std::array<std::uint8_t, 3> heat_color(double value);

/// All values of a plane; 3 bytes a pixel, rows as in the plane.
std::vector<std::uint8_t> heatmap(const Plane& errors);

}  // namespace lightwell::metrics
