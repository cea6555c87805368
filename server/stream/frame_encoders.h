// How a stream's frames become bytes: libjpeg-turbo and libavcodec, or stand-ins that fail when a test wants them to.
#pragma once

#include <functional>

#include "server/render/jpeg.h"
#include "server/video/video_encoder.h"

namespace lightwell {

/// Called on the encoders' threads, `video` on one at a time for each VideoEncoder.
struct FrameEncoders {
  std::function<Result<std::vector<std::uint8_t>>(std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality,
                                                  Chroma chroma)>
      jpeg = encode_jpeg;
  std::function<Result<VideoPacket>(VideoEncoder& stream, std::span<const std::uint8_t> rgbx, glm::ivec2 size_px,
                                    int quality, bool want_key)>
      video = &VideoEncoder::encode;
};

/// For tests of what must never happen: with a `fault` of "jpeg@N" or "video@N" one picture fails to be encoded as
/// that, after N others. Null, or anything else: the encoders as they are.
FrameEncoders encoders_with_fault(const char* fault);

}  // namespace lightwell
