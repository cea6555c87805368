// Writes PNGs of every kind for tests, uncompressed, without a PNG library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace lightwell {

using ByteVector = std::vector<std::byte>;

/// The colour types of the PNG specification.
enum class PngColor : std::uint8_t { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };

struct PngPicture {
  std::uint32_t width = 1, height = 1;
  PngColor color = PngColor::kRgb;
  std::uint8_t bit_depth = 8;
  std::vector<std::uint8_t> samples{};       // the rows one after another, as stored (16 bits: high byte first)
  std::vector<std::uint8_t> palette{};       // RGB triples
  std::vector<std::uint8_t> transparency{};  // alpha of the palette's colours
};

inline void append_big_endian(ByteVector& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

inline std::uint32_t png_crc(const ByteVector& bytes, std::size_t begin) {
  std::uint32_t crc = 0xffffffff;
  for (std::size_t i = begin; i < bytes.size(); ++i) {
    crc ^= std::to_integer<std::uint32_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
  }
  return ~crc;
}

inline void append_chunk(ByteVector& out, std::string_view name, const ByteVector& data) {
  append_big_endian(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  for (const char letter : name) out.push_back(static_cast<std::byte>(letter));
  out.insert(out.end(), data.begin(), data.end());
  append_big_endian(out, png_crc(out, begin));
}

/// A zlib stream of one stored block: at most 65535 bytes.
inline ByteVector zlib_stored(const ByteVector& data) {
  const auto length = static_cast<std::uint16_t>(data.size());
  ByteVector out{std::byte{0x78}, std::byte{0x01}, std::byte{1}};
  for (const std::uint16_t value : {length, static_cast<std::uint16_t>(~length)}) {
    out.push_back(static_cast<std::byte>(value & 0xff));
    out.push_back(static_cast<std::byte>(value >> 8));
  }
  out.insert(out.end(), data.begin(), data.end());
  std::uint32_t a = 1, b = 0;  // Adler-32
  for (const std::byte byte : data) {
    a = (a + std::to_integer<std::uint32_t>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  append_big_endian(out, b << 16 | a);
  return out;
}

inline ByteVector to_bytes(const std::vector<std::uint8_t>& values) {
  ByteVector bytes;
  for (const std::uint8_t value : values) bytes.push_back(std::byte{value});
  return bytes;
}

inline ByteVector make_png(const PngPicture& picture) {
  ByteVector out = to_bytes({0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'});
  ByteVector header;
  append_big_endian(header, picture.width);
  append_big_endian(header, picture.height);
  for (const std::uint8_t value :
       {picture.bit_depth, static_cast<std::uint8_t>(picture.color), std::uint8_t{0}, std::uint8_t{0}, std::uint8_t{0}})
    header.push_back(std::byte{value});
  append_chunk(out, "IHDR", header);
  if (!picture.palette.empty()) append_chunk(out, "PLTE", to_bytes(picture.palette));
  if (!picture.transparency.empty()) append_chunk(out, "tRNS", to_bytes(picture.transparency));
  ByteVector rows;
  const std::size_t row_bytes = picture.height > 0 ? picture.samples.size() / picture.height : 0;
  for (std::size_t i = 0; i < picture.samples.size(); ++i) {
    if (i % row_bytes == 0) rows.push_back(std::byte{0});  // the row's filter: none
    rows.push_back(std::byte{picture.samples[i]});
  }
  append_chunk(out, "IDAT", zlib_stored(rows));
  append_chunk(out, "IEND", {});
  return out;
}

/// A picture of one colour, to be embedded where only its presence matters.
inline ByteVector one_pixel_png(std::array<std::uint8_t, 4> rgba = {255, 255, 255, 255}) {
  return make_png({.color = PngColor::kRgba, .samples = {rgba.begin(), rgba.end()}});
}

}  // namespace lightwell
