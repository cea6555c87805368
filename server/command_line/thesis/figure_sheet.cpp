#include "server/command_line/thesis/figure_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/check.h"
#include "renderer/image_io/label.h"
#include "renderer/image_metrics/display.h"

namespace lightwell {

namespace {

constexpr int kLeastFont_px = 11;

std::size_t first_byte(const RgbImage& image, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size_px.x) + static_cast<std::size_t>(x));
}

std::array<double, 256> linear_of_bytes() {
  std::array<double, 256> linear;
  for (std::size_t byte = 0; byte < linear.size(); ++byte)
    linear[byte] = metrics::linear_from_srgb(static_cast<double>(byte) / 255.0);
  return linear;
}

// The part of pixel `i` that lies in [low, high).
double overlap(int i, double low, double high) {
  return std::min(high, i + 1.0) - std::max(low, static_cast<double>(i));
}

glm::dvec3 mean_light(const RgbImage& image, const std::array<double, 256>& linear, glm::dvec2 low, glm::dvec2 high) {
  glm::dvec3 sum(0.0);
  for (int y = static_cast<int>(low.y); y < std::min(image.size_px.y, static_cast<int>(std::ceil(high.y))); ++y)
    for (int x = static_cast<int>(low.x); x < std::min(image.size_px.x, static_cast<int>(std::ceil(high.x))); ++x) {
      const std::uint8_t* pixel = &image.rgb[first_byte(image, x, y)];
      sum += overlap(x, low.x, high.x) * overlap(y, low.y, high.y) *
             glm::dvec3(linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]);
    }
  return sum / ((high.x - low.x) * (high.y - low.y));
}

void paste(const RgbImage& image, glm::ivec2 corner_px, RgbImage& sheet) {
  for (int y = 0; y < image.size_px.y; ++y)
    std::copy_n(image.rgb.begin() + static_cast<std::ptrdiff_t>(first_byte(image, 0, y)), 3 * image.size_px.x,
                sheet.rgb.begin() + static_cast<std::ptrdiff_t>(first_byte(sheet, corner_px.x, corner_px.y + y)));
}

// In the middle over `width_px`, or from its left where it is too long for that.
Status draw_centered(RgbImage& sheet, glm::ivec2 left_px, int width_px, const std::string& text, int font_px) {
  const Result<int> text_px = label_width(text, font_px);
  if (!text_px) return text_px.error();
  left_px.x += std::max(0, (width_px - *text_px) / 2);
  return draw_label(sheet.rgb, sheet.size_px, left_px, text, font_px);
}

}  // namespace

RgbImage shrunk(const RgbImage& image, int side_px) {
  LIGHTWELL_CHECK_OP(side_px, <=, image.size_px.x);
  if (side_px == image.size_px.x) return image;
  static const std::array<double, 256> linear = linear_of_bytes();
  const double step = static_cast<double>(image.size_px.x) / side_px;
  RgbImage small{glm::ivec2(side_px), {}};
  small.rgb.reserve(3 * static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px));
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      const glm::dvec2 low = step * glm::dvec2(x, y);
      const glm::dvec3 mean = mean_light(image, linear, low, low + step);
      for (int channel = 0; channel < 3; ++channel)
        small.rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0 * metrics::srgb_from_linear(mean[channel]))));
    }
  return small;
}

SheetLayout::SheetLayout(const Sheet& sheet, int side_px) : panel_px(side_px), columns(sheet.columns) {
  rows = (static_cast<int>(sheet.cells.size()) + columns - 1) / columns;
  font_px = std::max(kLeastFont_px, panel_px / 18);
  title_font_px = font_px * 5 / 4;
  gap_px = std::max(8, font_px * 3 / 4);
  caption_px = font_px * 17 / 10;
  title_px = title_font_px * 2;
}

glm::ivec2 SheetLayout::size_px() const {
  return {gap_px + columns * (panel_px + gap_px), title_px + rows * (panel_px + caption_px + gap_px)};
}

glm::ivec2 SheetLayout::corner_px(std::size_t cell) const {
  const int column = static_cast<int>(cell) % columns, row = static_cast<int>(cell) / columns;
  return {gap_px + column * (panel_px + gap_px), title_px + row * (panel_px + caption_px + gap_px)};
}

int largest_panel(const Sheet& sheet, glm::ivec2 most_px) {
  int panel_px = std::max(1, std::min(most_px.x, most_px.y));
  const auto fits = [&] {
    const glm::ivec2 size_px = SheetLayout(sheet, panel_px).size_px();
    return size_px.x <= most_px.x && size_px.y <= most_px.y;
  };
  while (panel_px > 1 && !fits()) --panel_px;
  return panel_px;
}

Result<RgbImage> composed(const Sheet& sheet, int panel_px) {
  const SheetLayout layout(sheet, panel_px);
  RgbImage image{layout.size_px(), {}};
  image.rgb.assign(first_byte(image, 0, image.size_px.y), 255);
  const glm::ivec2 title_px(layout.gap_px, layout.title_font_px * 3 / 2);
  if (Status drawn = draw_label(image.rgb, image.size_px, title_px, sheet.title, layout.title_font_px); !drawn)
    return drawn.error();
  for (std::size_t i = 0; i < sheet.cells.size(); ++i) {
    if (!sheet.cells[i]) continue;
    const glm::ivec2 corner = layout.corner_px(i);
    paste(shrunk(sheet.cells[i]->image, panel_px), corner, image);
    const glm::ivec2 baseline = corner + glm::ivec2(0, panel_px + layout.font_px * 5 / 4);
    if (Status drawn = draw_centered(image, baseline, panel_px, sheet.cells[i]->caption, layout.font_px); !drawn)
      return drawn.error();
  }
  return image;
}

}  // namespace lightwell
