// Moving pictures as video, where this build has libavcodec: H.264 without B-frames, one packet for each picture, at
// once.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "server/video/codecs/codecs.h"

namespace lightwell {

/// Whether this build, with the libraries of this machine, can encode H.264. The first call loads them, which takes a
/// moment.
bool can_encode_video();

struct VideoPacket {
  std::uint64_t index = 0;  // ascending by one; a packet is decoded after the one before it, unless it is a key
  bool is_key = false;
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;  // Annex B; a key has its parameter sets before it
};

/// One stream of packets. Not thread-safe.
class VideoEncoder {
 public:
  /// Sides are even, since chroma is halved, and the picture is no larger than what decoders take.
  static bool takes(glm::ivec2 size_px);

  /// `rgbx`: 4 bytes a pixel of sRGB, row 0 at the top. `quality` as a JPEG's, 1..100. `want_key`: the packet is to
  /// stand for itself; it does so anyway where the size changes. kUnsupported without an encoder, kInternal where it
  /// cannot be loaded or fails.
  Result<VideoPacket> encode(std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality, bool want_key);

  /// Gives its memory back. The next packet is a key.
  void rest() { encoder_.reset(); }

 private:
  std::unique_ptr<video_codecs::PacketEncoder> encoder_;
  glm::ivec2 size_px_{};  // of the encoder
  std::uint64_t next_index_ = 1;
};

}  // namespace lightwell
