#include "protocol/frame_header.h"

#include <bit>
#include <cmath>

namespace lightwell::protocol {
namespace {

constexpr std::uint8_t kFrameType = 1;
constexpr std::uint8_t kKeyFlag = 1, kFinalFlag = 2, kLosslessFlag = 4;

template <class T>
void store(std::span<std::uint8_t> bytes, std::size_t offset, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[offset + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

template <class T>
T load(std::span<const std::uint8_t> bytes, std::size_t offset) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value = static_cast<T>(value | static_cast<T>(bytes[offset + i]) << (8 * i));
  return value;
}

FrameHeader load_header(std::span<const std::uint8_t> bytes) {
  const std::uint8_t flags = bytes[7];
  FrameHeader header;
  header.codec = static_cast<FrameCodec>(bytes[6]);
  header.is_key = (flags & kKeyFlag) != 0;
  header.is_final = (flags & kFinalFlag) != 0;
  header.is_lossless = (flags & kLosslessFlag) != 0;
  header.frame = load<std::uint32_t>(bytes, 8);
  header.input_seq = load<std::uint32_t>(bytes, 12);
  header.scene_revision = load<std::uint64_t>(bytes, 16);
  header.capture_ms = std::bit_cast<double>(load<std::uint64_t>(bytes, 24));
  header.scene_time_s = std::bit_cast<float>(load<std::uint32_t>(bytes, 32));
  header.width = load<std::uint16_t>(bytes, 36);
  header.height = load<std::uint16_t>(bytes, 38);
  header.payload_bytes = load<std::uint32_t>(bytes, 40);
  header.render_ms = std::bit_cast<float>(load<std::uint32_t>(bytes, 44));
  return header;
}

/// The first thing wrong, in the order of the bytes; null if nothing is. The browser's words are the same.
const char* what_is_wrong(std::span<const std::uint8_t> message) {
  if (message.size() < kFrameHeaderBytes) return "a frame shorter than its header";
  if (load<std::uint32_t>(message, 0) != kFrameMagic) return "not a frame: wrong magic";
  if (message[4] != kFrameVersion) return "unknown frame version";
  if (message[5] != kFrameType) return "unknown frame type";
  if (message[6] < 1 || message[6] > 3) return "unknown frame codec";
  const FrameHeader header = load_header(message);
  if (header.frame == 0) return "frame id 0";
  if (!std::isfinite(header.capture_ms)) return "capture time is not finite";
  if (!std::isfinite(header.scene_time_s)) return "scene time is not finite";
  if (header.width == 0 || header.height == 0) return "a frame without pixels";
  if (header.payload_bytes != message.size() - kFrameHeaderBytes) return "payload length does not match the message";
  if (!std::isfinite(header.render_ms)) return "render time is not finite";
  return nullptr;
}

}  // namespace

std::array<std::uint8_t, kFrameHeaderBytes> encode_frame_header(const FrameHeader& header) {
  std::array<std::uint8_t, kFrameHeaderBytes> bytes{};
  store(bytes, 0, kFrameMagic);
  bytes[4] = kFrameVersion;
  bytes[5] = kFrameType;
  bytes[6] = static_cast<std::uint8_t>(header.codec);
  bytes[7] = static_cast<std::uint8_t>((header.is_key ? kKeyFlag : 0) | (header.is_final ? kFinalFlag : 0) |
                                       (header.is_lossless ? kLosslessFlag : 0));
  store(bytes, 8, header.frame);
  store(bytes, 12, header.input_seq);
  store(bytes, 16, header.scene_revision);
  store(bytes, 24, std::bit_cast<std::uint64_t>(header.capture_ms));
  store(bytes, 32, std::bit_cast<std::uint32_t>(header.scene_time_s));
  store(bytes, 36, header.width);
  store(bytes, 38, header.height);
  store(bytes, 40, header.payload_bytes);
  store(bytes, 44, std::bit_cast<std::uint32_t>(header.render_ms));
  return bytes;
}

Decoded<DecodedFrame> decode_frame(std::span<const std::uint8_t> message) {
  if (const char* wrong = what_is_wrong(message)) return make_problem(400, wrong);
  return DecodedFrame{load_header(message), message.subspan(kFrameHeaderBytes)};
}

}  // namespace lightwell::protocol
