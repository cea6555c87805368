// Pictures to encode: smooth light with some detail in it, that moves.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lightwell::test {

/// 4 bytes a pixel, moved by `t` pixels.
inline std::vector<std::uint8_t> moving_picture(glm::ivec2 size_px, int t) {
  std::vector<std::uint8_t> picture;
  const auto channel = [](double value) { return static_cast<std::uint8_t>(128.0 + 90.0 * value); };
  for (int y = 0; y < size_px.y; ++y)
    for (int x = 0; x < size_px.x; ++x) {
      const double u = (x + t) * 0.05, v = y * 0.07;
      picture.insert(picture.end(),
                     {channel(std::sin(u)), channel(std::sin(u + v)), channel(std::cos(v) * std::cos(3.0 * u)), 255});
    }
  return picture;
}

}  // namespace lightwell::test
