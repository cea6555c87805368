// What the first bytes of a PNG or JPEG say about it, read before any decoder is trusted with the rest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "renderer/error.h"

namespace lightwell {

enum class ImageFormat { kPng, kJpeg };

struct EncodedImage {
  ImageFormat format = ImageFormat::kPng;
  std::uint32_t width_px = 0;  // at least 1
  std::uint32_t height_px = 0;
};

/// Recognises the format by its signature and finds the size. kUnsupported for any other format, kInvalidInput for a
/// header that is cut off or makes no sense and for a JPEG without its end (decoders fill such a picture with grey).
Result<EncodedImage> inspect_image(std::span<const std::byte> bytes);

}  // namespace lightwell
