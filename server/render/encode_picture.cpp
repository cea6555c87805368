#include "server/render/encode_picture.h"

#include "renderer/image_io/image_io.h"
#include "server/render/jpeg.h"

namespace lightwell {
namespace {

constexpr int kQuality = 95;

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<std::string> jpeg_file(const Frame& frame) {
  const auto file = encode_jpeg(frame.display_rgbx, frame.size_px, kQuality, Chroma::kFull);
  if (!file) return file.error();
  return std::string(file->begin(), file->end());
}

Result<std::string> png_file(const Frame& frame) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(frame.display_rgbx.size() / 4 * 3);
  for (std::size_t i = 0; i + 3 < frame.display_rgbx.size(); i += 4)
    rgb.insert(rgb.end(), &frame.display_rgbx[i], &frame.display_rgbx[i] + 3);
  const auto file = encode_ldr("png", frame.size_px, rgb);
  if (!file) return file.error();
  return text_of(*file);
}

Result<std::string> exr_file(const Frame& frame) {
  const auto file = encode_exr(FloatImage{frame.size_px, 3, frame.linear_rgb});
  if (!file) return file.error();
  return text_of(*file);
}

}  // namespace

Result<std::string> encode_picture(const Frame& frame, protocol::ImageFormat format) {
  switch (format) {
    case protocol::ImageFormat::kJpeg:
      return jpeg_file(frame);
    case protocol::ImageFormat::kPng:
      return png_file(frame);
    case protocol::ImageFormat::kExr:
      break;
  }
  return exr_file(frame);
}

}  // namespace lightwell
