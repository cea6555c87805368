// What the meter measures: linear pictures, and planes of one value a pixel.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "renderer/error.h"

namespace lightwell::metrics {

/// Linear BT.709, row 0 at the top, 3 floats a pixel.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<float> rgb;  // width * height * 3
  /// True: decoded from an sRGB file, 1 is the display's white, and nothing more is exposed or tone-mapped.
  /// False: scene-referred light of any scale.
  bool display_referred = false;

  std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// One float a pixel, rows as in Picture.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<float> values;

  Plane() = default;
  Plane(int plane_width, int plane_height)
      : width(plane_width),
        height(plane_height),
        values(static_cast<std::size_t>(plane_width) * static_cast<std::size_t>(plane_height)) {}
};

/// Mean of all values; 0 for an empty plane.
double mean_of(const Plane& plane);

/// Relative luminance of linear BT.709.
inline double luminance(double r, double g, double b) {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/// kInvalidInput if the two cannot be compared: no pixels, other sizes, one display-referred and the other not,
/// a value that is not finite (the error names picture, pixel and channel).
Status check_comparable(const Picture& test, const Picture& reference);

}  // namespace lightwell::metrics
