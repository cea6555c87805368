#include "renderer/scene/builtin/textures.h"

#include <algorithm>
#include <cmath>

namespace lightwell::builtin {
namespace {

/// A number in 0..1 from two whole ones; the mixing steps are those of the PCG family's output function.
float hash(int x, int y, std::uint32_t seed) {
  std::uint32_t state =
      static_cast<std::uint32_t>(x) * 0x9e3779b9u + static_cast<std::uint32_t>(y) * 0x85ebca6bu + seed;
  state = state * 747796405u + 2891336453u;
  state = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return static_cast<float>(((state >> 22u) ^ state) >> 8u) / 16777216.0f;
}

/// Smooth noise in -1..1 over the unit square, `cells` to a side, tileable.
float noise(const glm::vec2& uv, int cells, std::uint32_t seed) {
  const glm::vec2 at = uv * static_cast<float>(cells);
  const glm::ivec2 cell(glm::floor(at));
  const glm::vec2 f = at - glm::vec2(cell), s = f * f * (3.0f - 2.0f * f);
  const auto corner = [&](int x, int y) { return hash((cell.x + x) % cells, (cell.y + y) % cells, seed); };
  const float value =
      glm::mix(glm::mix(corner(0, 0), corner(1, 0), s.x), glm::mix(corner(0, 1), corner(1, 1), s.x), s.y);
  return 2.0f * value - 1.0f;
}

/// Octaves of noise, each twice as fine and half as strong, in about -1..1.
float clouds(const glm::vec2& uv, int cells, int octaves, std::uint32_t seed) {
  float sum = 0.0f, strength = 0.5f;
  for (int i = 0; i < octaves; ++i, strength *= 0.5f, cells *= 2)
    sum += strength * noise(uv, cells, seed + static_cast<std::uint32_t>(i));
  return sum;
}

std::uint8_t to_srgb(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float encoded = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255.0f * encoded));
}

template <class Color>
Image paint(std::string name, int size_px, const Color& color) {
  Image image{std::move(name), {size_px, size_px}, {}};
  image.rgba.reserve(static_cast<std::size_t>(size_px) * static_cast<std::size_t>(size_px) * 4);
  for (int y = 0; y < size_px; ++y)
    for (int x = 0; x < size_px; ++x) {
      const glm::vec3 c = color((glm::vec2(x, y) + 0.5f) / static_cast<float>(size_px));
      for (int i = 0; i < 3; ++i) image.rgba.push_back(to_srgb(c[i]));
      image.rgba.push_back(255);
    }
  return image;
}

}  // namespace

Image flagstones(int size_px, int columns, int rows, const glm::vec3& albedo, float joint) {
  return paint("flagstones", size_px, [=](const glm::vec2& uv) {
    const float row = uv.y * static_cast<float>(rows);
    const int r = static_cast<int>(row);
    const float column = uv.x * static_cast<float>(columns) + (r % 2 == 0 ? 0.0f : 0.5f);
    const int c = static_cast<int>(column) % columns;
    const glm::vec2 in_stone(column - std::floor(column), row - std::floor(row));
    const glm::vec2 to_edge = glm::min(in_stone, 1.0f - in_stone);
    const float edge = std::min(to_edge.x, to_edge.y) + 0.006f * noise(uv, 64, 5u);
    const float stone = 0.84f + 0.26f * hash(c, r, 11u);
    const float warmth = 0.05f * (hash(c, r, 23u) - 0.5f);
    const float wear = 1.0f + 0.10f * clouds(uv, 16, 4, 31u + static_cast<std::uint32_t>(7 * c + 131 * r));
    const float open = glm::smoothstep(0.5f * joint, 1.3f * joint, edge);
    return albedo * glm::vec3(1.0f + warmth, 1.0f, 1.0f - warmth) * stone * wear * glm::mix(0.45f, 1.0f, open);
  });
}

Image plaster(int size_px, const glm::vec3& albedo, float contrast) {
  return paint("plaster", size_px, [=](const glm::vec2& uv) {
    return albedo * (1.0f + contrast * (clouds(uv, 4, 5, 41u) + 0.5f * clouds(uv, 32, 2, 43u)));
  });
}

}  // namespace lightwell::builtin
