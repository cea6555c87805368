#include "renderer/image_io/image_io.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "renderer/image_io/encoded_image.h"
#include "renderer/image_io/exr_header.h"
#include "renderer/image_io/label.h"
#include "renderer/image_io/load_codecs.h"

namespace lightwell {

namespace {

Status write_file(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return invalid_input(path.string(), std::string("cannot be written: ") + std::strerror(errno));
  return Done{};
}

}  // namespace

Status load_image_codecs() {
  const auto codecs = image_codecs();
  if (!codecs) return codecs.error();
  return Done{};
}

Result<Image> decode_image(std::span<const std::byte> bytes, std::uint64_t max_pixels) {
  const Result<EncodedImage> encoded = inspect_image(bytes);
  if (!encoded) return encoded.error();
  const std::uint64_t pixels = std::uint64_t{encoded->width_px} * encoded->height_px;
  if (pixels > max_pixels)
    return Error{ErrorKind::kTooLarge, "",
                 "the image has " + std::to_string(encoded->width_px) + " x " + std::to_string(encoded->height_px) +
                     " pixels; at most " + std::to_string(max_pixels) + " are allowed"};
  const auto codecs = image_codecs();
  return codecs ? (*codecs)->decode_image(bytes, *encoded) : codecs.error();
}

Result<FloatImage> read_image(const std::filesystem::path& path, std::uint64_t max_pixels) {
  const auto codecs = image_codecs();
  if (!codecs) return codecs.error();
  if (const Status header = check_exr_header(path); !header) return header.error();
  return (*codecs)->read_image(path, max_pixels);
}

Result<std::vector<std::byte>> encode_exr(const FloatImage& image, const std::map<std::string, std::string>& metadata,
                                          bool float32) {
  const auto codecs = image_codecs();
  return codecs ? (*codecs)->encode_exr(image, metadata, float32) : codecs.error();
}

Result<std::vector<std::byte>> encode_exr_layers(glm::ivec2 size_px, std::span<const ExrLayer> layers,
                                                 const std::map<std::string, std::string>& metadata) {
  const auto codecs = image_codecs();
  return codecs ? (*codecs)->encode_exr_layers(size_px, layers, metadata) : codecs.error();
}

Result<std::vector<std::byte>> encode_ldr(const std::string& format, glm::ivec2 size_px,
                                          std::span<const std::uint8_t> rgb, int jpeg_quality) {
  const auto codecs = image_codecs();
  return codecs ? (*codecs)->encode_ldr(format, size_px, rgb, jpeg_quality) : codecs.error();
}

Status write_exr(const std::filesystem::path& path, const FloatImage& image,
                 const std::map<std::string, std::string>& metadata, bool float32) {
  const Result<std::vector<std::byte>> encoded = encode_exr(image, metadata, float32);
  if (!encoded) return encoded.error();
  return write_file(path, *encoded);
}

Status write_ldr(const std::filesystem::path& path, glm::ivec2 size_px, std::span<const std::uint8_t> rgb,
                 int jpeg_quality) {
  std::string format = path.extension().string();
  if (!format.empty()) format.erase(0, 1);
  std::transform(format.begin(), format.end(), format.begin(),
                 [](char letter) { return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter + 32) : letter; });
  Result<std::vector<std::byte>> encoded = encode_ldr(format, size_px, rgb, jpeg_quality);
  if (!encoded) return encoded.error();
  return write_file(path, *encoded);
}

Result<int> label_width(const std::string& text, int font_px) {
  const auto codecs = image_codecs();
  return codecs ? (*codecs)->label_width(text, font_px) : codecs.error();
}

Status draw_label(std::span<std::uint8_t> rgb, glm::ivec2 size_px, glm::ivec2 baseline_px, const std::string& text,
                  int font_px) {
  const auto codecs = image_codecs();
  return codecs ? (*codecs)->draw_label(rgb, size_px, baseline_px, text, font_px) : codecs.error();
}

}  // namespace lightwell
