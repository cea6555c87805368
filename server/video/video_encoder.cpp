#include "server/video/video_encoder.h"

#include "renderer/check.h"
#include "server/video/film.h"
#include "server/video/load_codecs.h"

namespace lightwell {
namespace {

constexpr std::int64_t kMostMacroblocks = 36'864;  // of a picture, by H.264's table A-1 for level 5.2

}  // namespace

bool can_encode_video() {
  static const bool can = [] {
    const auto codecs = video_codecs_table();
    return codecs && (*codecs)->can_encode();
  }();
  return can;
}

bool VideoEncoder::takes(glm::ivec2 size_px) {
  const glm::ivec2 macroblocks = (size_px + 15) / 16;
  return size_px.x % 2 == 0 && size_px.y % 2 == 0 &&
         static_cast<std::int64_t>(macroblocks.x) * macroblocks.y <= kMostMacroblocks;
}

Result<VideoPacket> VideoEncoder::encode(std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality,
                                         bool want_key) {
  if (!encoder_ || size_px_ != size_px) {
    const auto codecs = video_codecs_table();
    if (!codecs) return codecs.error();
    auto opened = (*codecs)->open_packets(size_px, quality);
    if (!opened) return opened.error();
    encoder_ = std::move(opened).value();
    size_px_ = size_px;
  }
  Result<video_codecs::Packet> packet = encoder_->encode(rgbx, quality, want_key);
  if (!packet) {
    rest();  // whatever comes next begins anew
    return packet.error();
  }
  return VideoPacket{next_index_++, packet->is_key,
                     std::make_shared<const std::vector<std::uint8_t>>(std::move(packet->bytes))};
}

Result<std::unique_ptr<FilmEncoder>> open_film(glm::ivec2 size_px, double fps) {
  LIGHTWELL_CHECK(VideoEncoder::takes(size_px));
  const auto codecs = video_codecs_table();
  if (!codecs) return codecs.error();
  return (*codecs)->open_film(size_px, fps);
}

}  // namespace lightwell
