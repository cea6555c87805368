// A frame's 48-byte header: one binary message is a header, then the picture's file.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "protocol/decoded.h"

namespace lightwell::protocol {

inline constexpr std::size_t kFrameHeaderBytes = 48;
inline constexpr std::uint32_t kFrameMagic = 0x3146574c;  // "LWF1"
inline constexpr std::uint8_t kFrameVersion = 1;

enum class FrameCodec : std::uint8_t { kJpeg = 1, kPng = 2, kH264 = 3 };

struct FrameHeader {
  FrameCodec codec = FrameCodec::kJpeg;
  bool is_key = true;     // can be decoded without an earlier frame
  bool is_final = false;  // nothing finer follows until something changes
  bool is_lossless = false;
  std::uint32_t frame = 1;      // id, ascending from 1
  std::uint32_t input_seq = 0;  // the last input that this picture shows; 0 if none
  std::uint64_t scene_revision = 0;
  double capture_ms = 0.0;  // server clock
  float scene_time_s = 0.0f;
  std::uint16_t width = 1, height = 1;  // pixels
  std::uint32_t payload_bytes = 0;
  float render_ms = 0.0f;

  bool operator==(const FrameHeader&) const = default;
};

struct DecodedFrame {
  FrameHeader header;
  std::span<const std::uint8_t> payload;  // within the message
};

/// Little-endian, as README.md's table says.
std::array<std::uint8_t, kFrameHeaderBytes> encode_frame_header(const FrameHeader& header);

/// Refuses (status 400) a message that is too short or whose magic, version, type or codec is not known, whose id or
/// size is 0, whose times are not finite, or whose payload is not as long as the header says. Flags that version 1
/// does not name are ignored.
Decoded<DecodedFrame> decode_frame(std::span<const std::uint8_t> message);

}  // namespace lightwell::protocol
