#include "renderer/passes/environment_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr glm::ivec2 kGradientCells(8, 64);
constexpr glm::ivec2 kMostImageCells(512, 256);

double luminance(const glm::vec3& color) {
  return 0.2126 * static_cast<double>(color.r) + 0.7152 * static_cast<double>(color.g) +
         0.0722 * static_cast<double>(color.b);
}

double solid_angle(int row, const glm::ivec2& cells) {
  const double top = std::cos(kPi * row / cells.y), bottom = std::cos(kPi * (row + 1) / cells.y);
  return (top - bottom) * 2.0 * kPi / cells.x;
}

// The gradient of shaders/environment.glsl, without its strength.
double gradient_luminance(const Environment& environment, float up) {
  if (up >= 0.0f) return luminance(glm::mix(environment.horizon_radiance, environment.zenith_radiance, std::sqrt(up)));
  return luminance(
      glm::mix(environment.horizon_radiance, environment.ground_radiance, glm::smoothstep(0.0f, 0.15f, -up)));
}

EnvironmentCells gradient_cells(const Environment& environment) {
  EnvironmentCells cells{kGradientCells, {}};
  constexpr int kSteps = 8;  // of one row
  for (int row = 0; row < cells.size.y; ++row) {
    double mean = 0.0;
    for (int step = 0; step < kSteps; ++step) {
      const double theta = kPi * (row + (step + 0.5) / kSteps) / cells.size.y;
      mean += gradient_luminance(environment, static_cast<float>(std::cos(theta))) / kSteps;
    }
    cells.weights.insert(cells.weights.end(), static_cast<std::size_t>(cells.size.x),
                         mean * solid_angle(row, cells.size));
  }
  return cells;
}

// The mean of the texels in a cell and of those around it, which bilinear interpolation brings in.
double cell_luminance(const ImageHdr& image, const glm::ivec2& cell, const glm::ivec2& cells) {
  const glm::ivec2 first = cell * image.size_px / cells - 1;
  const glm::ivec2 last = ((cell + 1) * image.size_px + cells - 1) / cells;
  double sum = 0.0;
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      const int column = (x % image.size_px.x + image.size_px.x) % image.size_px.x;
      const int row = std::clamp(y, 0, image.size_px.y - 1);
      const std::size_t texel = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.size_px.x) +
                                     static_cast<std::size_t>(column));
      sum += luminance({image.rgb[texel], image.rgb[texel + 1], image.rgb[texel + 2]});
    }
  const glm::ivec2 size = last - first + 1;
  return sum / (static_cast<double>(size.x) * size.y);
}

EnvironmentCells image_cells(const ImageHdr& image) {
  EnvironmentCells cells{glm::min(image.size_px, kMostImageCells), {}};
  for (int y = 0; y < cells.size.y; ++y)
    for (int x = 0; x < cells.size.x; ++x)
      cells.weights.push_back(cell_luminance(image, {x, y}, cells.size) * solid_angle(y, cells.size));
  return cells;
}

}  // namespace

EnvironmentCells make_environment_cells(const Environment& environment) {
  const bool has_image = environment.image && !environment.image->rgb.empty();
  EnvironmentCells cells = has_image ? image_cells(*environment.image) : gradient_cells(environment);
  for (double& weight : cells.weights) weight *= static_cast<double>(environment.strength);
  if (std::none_of(cells.weights.begin(), cells.weights.end(), [](double weight) { return weight > 0.0; })) return {};
  return cells;
}

}  // namespace lightwell
