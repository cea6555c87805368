// In place of video_encoder.cpp where a build has no libavcodec.
#include "server/video/video_encoder.h"

namespace lightwell {

struct VideoEncoder::State {};

VideoEncoder::VideoEncoder() = default;

VideoEncoder::~VideoEncoder() = default;

bool can_encode_video() {
  return false;
}

bool VideoEncoder::takes(glm::ivec2) {
  return false;
}

void VideoEncoder::rest() {}

Result<VideoPacket> VideoEncoder::encode(std::span<const std::uint8_t>, glm::ivec2, int, bool) {
  return Error{ErrorKind::kUnsupported, "video", "this build has no libavcodec"};
}

}  // namespace lightwell
