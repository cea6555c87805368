// The colour spaces of FLIP, each from linear BT.709 with the white point that (1, 1, 1) has there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwell::metrics {

using Color = std::array<double, 3>;

/// CIE 1931 XYZ by the exact quotients of sRGB's primaries and white.
inline Color xyz_from_linear(const Color& rgb) {
  return {(10135552.0 * rgb[0] + 8788810.0 * rgb[1] + 4435075.0 * rgb[2]) / 24577794.0,
          (2613072.0 * rgb[0] + 8788810.0 * rgb[1] + 887015.0 * rgb[2]) / 12288897.0,
          (1425312.0 * rgb[0] + 8788810.0 * rgb[1] + 70074185.0 * rgb[2]) / 73733382.0};
}

inline Color linear_from_xyz(const Color& xyz) {
  return {3.241003275 * xyz[0] - 1.537398934 * xyz[1] - 0.498615861 * xyz[2],
          -0.969224334 * xyz[0] + 1.875930071 * xyz[1] + 0.041554224 * xyz[2],
          0.055639423 * xyz[0] - 0.204011202 * xyz[1] + 1.057148933 * xyz[2]};
}

inline Color white_xyz() {
  return xyz_from_linear({1.0, 1.0, 1.0});
}

/// The linear opponent space in which FLIP filters: luma, red-green, blue-yellow.
inline Color ycxcz_from_linear(const Color& rgb) {
  const Color xyz = xyz_from_linear(rgb), white = white_xyz();
  const double x = xyz[0] / white[0], y = xyz[1] / white[1], z = xyz[2] / white[2];
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

inline Color linear_from_ycxcz(const Color& ycxcz) {
  const Color white = white_xyz();
  const double y = (ycxcz[0] + 16.0) / 116.0;
  return linear_from_xyz({(y + ycxcz[1] / 500.0) * white[0], y * white[1], (y - ycxcz[2] / 200.0) * white[2]});
}

/// CIELAB with Hunt's adjustment: chroma counts less where it is dark.
inline Color hunt_lab_from_linear(const Color& rgb) {
  constexpr double kDelta = 6.0 / 29.0;
  const auto curve = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
  };
  const Color xyz = xyz_from_linear(rgb), white = white_xyz();
  const double x = curve(xyz[0] / white[0]), y = curve(xyz[1] / white[1]), z = curve(xyz[2] / white[2]);
  const double lightness = 116.0 * y - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)};
}

/// HyAB: city-block in lightness, Euclidean in chroma.
inline double hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

}  // namespace lightwell::metrics
