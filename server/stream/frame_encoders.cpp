#include "server/stream/frame_encoders.h"

#include <atomic>
#include <cstdlib>
#include <string_view>

namespace lightwell {
namespace {

Error failure() {
  return Error{ErrorKind::kInternal, "encoder", "LIGHTWELL_FAULT says so"};
}

}  // namespace

FrameEncoders encoders_with_fault(const char* fault) {
  const std::string_view text = fault ? fault : "";
  const std::size_t at = text.find('@');
  FrameEncoders encoders;
  if (at == std::string_view::npos) return encoders;
  const auto left = std::make_shared<std::atomic<int>>(std::atoi(fault + at + 1));
  if (text.starts_with("jpeg@"))
    encoders.jpeg = [left](std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality,
                           Chroma chroma) -> Result<std::vector<std::uint8_t>> {
      if ((*left)-- == 0) return failure();
      return encode_jpeg(rgbx, size_px, quality, chroma);
    };
  if (text.starts_with("video@"))
    encoders.video = [left](VideoEncoder& stream, std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality,
                            bool want_key) -> Result<VideoPacket> {
      if ((*left)-- == 0) return failure();
      return stream.encode(rgbx, size_px, quality, want_key);
    };
  return encoders;
}

}  // namespace lightwell
