#include "renderer/image_io/encoded_image.h"

#include <algorithm>
#include <array>

namespace lightwell {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

std::uint32_t byte_at(Bytes bytes, std::size_t offset) {
  return std::to_integer<std::uint32_t>(bytes[offset]);
}

std::uint32_t big_endian_16(Bytes bytes, std::size_t offset) {
  return byte_at(bytes, offset) << 8 | byte_at(bytes, offset + 1);
}

std::uint32_t big_endian_32(Bytes bytes, std::size_t offset) {
  return big_endian_16(bytes, offset) << 16 | big_endian_16(bytes, offset + 2);
}

bool is_png(Bytes bytes) {
  return bytes.size() >= kPngSignature.size() &&
         std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin(),
                    [](std::uint8_t expected, std::byte actual) { return std::byte{expected} == actual; });
}

bool is_jpeg(Bytes bytes) {
  return bytes.size() >= 3 && byte_at(bytes, 0) == 0xff && byte_at(bytes, 1) == 0xd8 && byte_at(bytes, 2) == 0xff;
}

Result<EncodedImage> with_size(ImageFormat format, std::uint32_t width_px, std::uint32_t height_px) {
  // 2^31 and more is not a size in either format and would not fit the signed sizes used everywhere else.
  constexpr std::uint32_t kMaxSide = 0x7fffffff;
  if (width_px == 0 || height_px == 0 || width_px > kMaxSide || height_px > kMaxSide)
    return invalid_input(
        "", "the image's size is " + std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels");
  return EncodedImage{format, width_px, height_px};
}

Result<EncodedImage> inspect_png(Bytes bytes) {
  // The signature is followed by the IHDR chunk: length, name, width, height, five bytes more, checksum.
  constexpr std::size_t kHeaderEnd = 8 + 8 + 13 + 4;
  if (bytes.size() < kHeaderEnd) return invalid_input("", "the PNG ends within its header");
  constexpr std::uint32_t kHeaderName = 0x49484452;  // "IHDR"
  if (big_endian_32(bytes, 8) != 13 || big_endian_32(bytes, 12) != kHeaderName)
    return invalid_input("", "the PNG does not begin with its header chunk");
  return with_size(ImageFormat::kPng, big_endian_32(bytes, 16), big_endian_32(bytes, 20));
}

bool is_frame_header(std::uint32_t marker) {
  constexpr std::uint32_t kHuffmanTables = 0xc4, kExtension = 0xc8, kArithmeticTables = 0xcc;
  return marker >= 0xc0 && marker <= 0xcf && marker != kHuffmanTables && marker != kExtension &&
         marker != kArithmeticTables;
}

bool has_end_of_image(Bytes bytes) {
  constexpr std::array<std::byte, 2> kEndOfImage{std::byte{0xff}, std::byte{0xd9}};
  return std::search(bytes.begin(), bytes.end(), kEndOfImage.begin(), kEndOfImage.end()) != bytes.end();
}

// Walks the segments up to the first scan: 0xff, a marker, a length that counts itself, and so on.
Result<EncodedImage> inspect_jpeg(Bytes bytes) {
  constexpr std::uint32_t kStartOfScan = 0xda;
  std::uint32_t width_px = 0, height_px = 0;
  std::size_t offset = 2;
  while (offset + 4 <= bytes.size()) {
    if (byte_at(bytes, offset) != 0xff) return invalid_input("", "the JPEG has no marker where one must be");
    const std::uint32_t marker = byte_at(bytes, offset + 1);
    if (marker == 0xff) {  // padding before a marker
      ++offset;
      continue;
    }
    const std::size_t length = big_endian_16(bytes, offset + 2);
    const Bytes segment = bytes.subspan(offset + 2);
    if (length < 2 || length > segment.size()) return invalid_input("", "the JPEG ends within its headers");
    if (is_frame_header(marker)) {
      if (length < 8) return invalid_input("", "the JPEG's frame header is too short");
      height_px = big_endian_16(segment, 3);
      width_px = big_endian_16(segment, 5);
    }
    if (marker == kStartOfScan) {
      if (!has_end_of_image(segment.subspan(length))) return invalid_input("", "the JPEG is cut off");
      return with_size(ImageFormat::kJpeg, width_px, height_px);
    }
    offset += 2 + length;
  }
  return invalid_input("", "the JPEG ends within its headers");
}

}  // namespace

Result<EncodedImage> inspect_image(Bytes bytes) {
  if (is_png(bytes)) return inspect_png(bytes);
  if (is_jpeg(bytes)) return inspect_jpeg(bytes);
  return Error{ErrorKind::kUnsupported, "", "the image is neither a PNG nor a JPEG"};
}

}  // namespace lightwell
