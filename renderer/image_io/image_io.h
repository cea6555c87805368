// Image files through OpenImageIO, and nowhere else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Loads OpenImageIO, which the first of these functions would do otherwise: a third of a second in which other threads
/// cannot do much either, for the loader's lock is held while what is thread-local is looked up anew. Thread-safe.
/// kInternal names what is missing.
Status load_image_codecs();

/// Decodes a PNG or JPEG, the two formats of glTF, from memory to RGBA8: grey is spread over RGB, what has no alpha is
/// opaque, alpha stays straight (colours are not multiplied by it), 16 bits become 8, CMYK becomes RGB. The size is
/// read from the file's own header and refused with kTooLarge above `max_pixels` before anything is decoded.
/// Data in any other format is kUnsupported; broken or truncated data is kInvalidInput.
Result<Image> decode_image(std::span<const std::byte> bytes, std::uint64_t max_pixels);

/// A floating-point picture, row 0 at the top, `channels` interleaved values a pixel (3 or 4).
struct FloatImage {
  glm::ivec2 size_px{0};
  int channels = 3;
  std::vector<float> pixels;
};

/// The most pixels read_image accepts unless told otherwise.
inline constexpr std::uint64_t kMaxReadPixels = 16384ull * 16384;

/// Reads an image file, of the format that its ending names, as linear floats: .exr and .hdr as they are, integer files
/// decoded from sRGB. Grey is spread over RGB; channels beyond alpha are left out; alpha is as the file has it. NaN and
/// infinities are kept, so that a comparison can find them: whoever needs finite values must look. A missing file is
/// kNotFound, one of more than `max_pixels` is kTooLarge, before memory is taken for it.
Result<FloatImage> read_image(const std::filesystem::path& path, std::uint64_t max_pixels = kMaxReadPixels);

/// Writes scene-referred linear .exr (32-bit floats, or half by `float32`); metadata goes into the header as strings.
/// The same picture and metadata give the same bytes: no time of writing is recorded.
Status write_exr(const std::filesystem::path& path, const FloatImage& image,
                 const std::map<std::string, std::string>& metadata = {}, bool float32 = true);

/// Writes 8-bit display-referred sRGB pixels (3 channels) as .png or .jpg by the path's ending.
Status write_ldr(const std::filesystem::path& path, glm::ivec2 size_px, std::span<const std::uint8_t> rgb,
                 int jpeg_quality = 95);

/// The same in memory. `format` is "png" or "jpg" (or "jpeg").
Result<std::vector<std::byte>> encode_ldr(const std::string& format, glm::ivec2 size_px,
                                          std::span<const std::uint8_t> rgb, int jpeg_quality = 95);
Result<std::vector<std::byte>> encode_exr(const FloatImage& image,
                                          const std::map<std::string, std::string>& metadata = {}, bool float32 = true);

/// One layer of a picture with several.
struct ExrLayer {
  std::string name;            // its channels are name.R, name.G and name.B; empty: R, G and B
  std::span<const float> rgb;  // as FloatImage::pixels with 3 channels
};

/// An .exr of several layers of one size in a single part, 32-bit floats; at least one.
Result<std::vector<std::byte>> encode_exr_layers(glm::ivec2 size_px, std::span<const ExrLayer> layers,
                                                 const std::map<std::string, std::string>& metadata = {});

}  // namespace lightwell
