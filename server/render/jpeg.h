// Pixels into a JPEG file through libjpeg-turbo.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/error.h"

namespace lightwell {

enum class Chroma {
  kHalved,  // 4:2:0: half the bytes, softer edges of colour
  kFull,    // 4:4:4
};

/// `rgbx`: 4 bytes a pixel, row 0 at the top. `quality`: 1..100. Each thread keeps its encoder for the next picture.
Result<std::vector<std::uint8_t>> encode_jpeg(std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality,
                                              Chroma chroma);

}  // namespace lightwell
