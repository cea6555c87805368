// Image files through OpenImageIO, and nowhere else.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Decodes a PNG or JPEG (whatever OpenImageIO reads) from memory to RGBA8. Refuses more than `max_pixels`.
Result<Image> decode_image(std::span<const std::byte> bytes, std::uint64_t max_pixels);

/// A floating-point picture, row 0 at the top, `channels` interleaved values a pixel (3 or 4).
struct FloatImage {
  glm::ivec2 size_px{0};
  int channels = 3;
  std::vector<float> pixels;
};

/// Reads any image file as linear floats: .exr and .hdr as they are, 8-bit files decoded from sRGB.
Result<FloatImage> read_image(const std::filesystem::path& path);

/// Writes scene-referred linear .exr (half or float by `float32`); metadata goes into the header as strings.
Status write_exr(const std::filesystem::path& path, const FloatImage& image,
                 const std::map<std::string, std::string>& metadata = {}, bool float32 = true);

/// Writes 8-bit display-referred sRGB pixels (3 channels) as .png or .jpg by the path's ending.
Status write_ldr(const std::filesystem::path& path, glm::ivec2 size_px, std::span<const std::uint8_t> rgb,
                 int jpeg_quality = 95);

/// The same in memory. `format` is "png", "jpg" or "exr" (exr takes linear floats instead).
Result<std::vector<std::byte>> encode_ldr(const std::string& format, glm::ivec2 size_px,
                                          std::span<const std::uint8_t> rgb, int jpeg_quality = 95);
Result<std::vector<std::byte>> encode_exr(const FloatImage& image,
                                          const std::map<std::string, std::string>& metadata = {});

}  // namespace lightwell
