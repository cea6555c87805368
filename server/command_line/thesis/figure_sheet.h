// Pictures and their captions on one sheet.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/error.h"

namespace lightwell {

/// 8-bit sRGB, 3 bytes a pixel, row 0 at the top.
struct RgbImage {
  glm::ivec2 size_px{0};
  std::vector<std::uint8_t> rgb;
};

/// `image`, square, as a picture of side x side pixels that is not larger: each pixel is the mean light of the area it
/// covers.
RgbImage shrunk(const RgbImage& image, int side_px);

struct CaptionedImage {
  RgbImage image;  // square
  std::string caption;
};

struct Sheet {
  std::string title;
  int columns = 1;
  std::vector<std::optional<CaptionedImage>> cells;  // row by row; an empty one stays white
};

/// Where things stand on a sheet whose pictures have a side of `panel_px`.
struct SheetLayout {
  int panel_px = 0, columns = 1, rows = 0;
  int font_px = 0, title_font_px = 0, gap_px = 0, caption_px = 0, title_px = 0;

  SheetLayout(const Sheet& sheet, int side_px);
  glm::ivec2 size_px() const;
  /// The upper left corner of the picture in a cell.
  glm::ivec2 corner_px(std::size_t cell) const;
};

/// The largest side of the pictures, at least 1, with which the sheet is not larger than `most_px`.
int largest_panel(const Sheet& sheet, glm::ivec2 most_px);

/// The whole sheet with its pictures shrunk to `panel_px`. Errors as label_width's.
Result<RgbImage> composed(const Sheet& sheet, int panel_px);

}  // namespace lightwell
