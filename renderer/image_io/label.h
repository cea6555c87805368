// Words on pictures.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "renderer/error.h"

namespace lightwell {

/// How wide `text` is at a size of `font_px`, in pixels. kNotFound names the Debian package where the font, DejaVu
/// Sans, is not installed. ASCII only.
Result<int> label_width(const std::string& text, int font_px);

/// Draws `text` in black over an 8-bit RGB picture of `size_px`, its baseline's left end at `baseline_px` (row 0 at the
/// top). What lies outside the picture is cut off. Errors as above; kInvalidInput if `rgb` is not of that size.
Status draw_label(std::span<std::uint8_t> rgb, glm::ivec2 size_px, glm::ivec2 baseline_px, const std::string& text,
                  int font_px);

}  // namespace lightwell
