#include "server/video/video_encoder.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <string>

#include "server/video/libav.h"

namespace lightwell {
namespace {

constexpr AVRational kTimeBase{1, 60};             // of the numbers of packets; nobody plays them by a clock
constexpr std::int64_t kMostMacroblocks = 36'864;  // of a picture, by H.264's table A-1 for level 5.2

/// A constant rate factor that gives what moves as little error as a JPEG of that quality has, or less, in fewer bytes
/// (`helicopters`, 512 x 384, quality 80: 36.5 dB in 11.3 kB a picture; JPEG 35.7 dB in 13.7 kB).
double rate_factor(int quality) {
  return std::clamp(20.0 + (80 - quality) * 0.25, 16.0, 40.0);
}

}  // namespace

bool can_encode_video() {
  static const bool can = [] {
    av_log_set_level(AV_LOG_ERROR);  // the server's log is its own
    return avcodec_find_encoder_by_name(libav::kEncoder) != nullptr;
  }();
  return can;
}

bool VideoEncoder::takes(glm::ivec2 size_px) {
  const glm::ivec2 macroblocks = (size_px + 15) / 16;
  return size_px.x % 2 == 0 && size_px.y % 2 == 0 &&
         static_cast<std::int64_t>(macroblocks.x) * macroblocks.y <= kMostMacroblocks;
}

struct VideoEncoder::State {
  explicit State(glm::ivec2 picture_size_px) : size_px(picture_size_px) {}

  Status open(int quality) {
    context = libav::encoder_context(size_px);
    packet.reset(av_packet_alloc());
    if (!context || !packet) return Error{ErrorKind::kUnsupported, "libavcodec", "no H.264 encoder can be had"};
    context->time_base = kTimeBase;
    context->max_b_frames = 0;
    const bool set = libav::set_option(*context, "preset", "ultrafast") &&
                     libav::set_option(*context, "tune", "zerolatency") &&
                     libav::set_option(*context, "profile", "baseline") &&
                     libav::set_option(*context, "x264-params", "keyint=infinite:scenecut=0") &&  // keys when asked for
                     libav::set_option(*context, "forced-idr", "1") && set_quality(quality);
    if (!set) return Error{ErrorKind::kUnsupported, "libavcodec", "the H.264 encoder is another than libx264"};
    if (const int code = avcodec_open2(context.get(), nullptr, nullptr); code < 0)
      return libav::failure("the encoder does not open", code);
    return picture.open(size_px);
  }

  bool set_quality(int quality) const {
    return av_opt_set_double(context->priv_data, "crf", rate_factor(quality), 0) >= 0;
  }

  /// One packet for each picture, at once: the encoder is told to keep none.
  Status encode(std::span<const std::uint8_t> rgbx, std::uint64_t index, bool want_key) {
    if (const Status converted = picture.convert(rgbx); !converted) return converted;
    picture.frame()->pts = static_cast<std::int64_t>(index);
    picture.frame()->pict_type = want_key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
    int code = avcodec_send_frame(context.get(), picture.frame());
    if (code >= 0) code = avcodec_receive_packet(context.get(), packet.get());
    if (code < 0) return libav::failure("a picture does not encode", code);
    return Done{};
  }

  glm::ivec2 size_px;
  libav::Owned<AVCodecContext> context;
  libav::Owned<AVPacket> packet;
  libav::ConvertedPicture picture;
};

VideoEncoder::VideoEncoder() = default;

VideoEncoder::~VideoEncoder() = default;

void VideoEncoder::rest() {
  state_.reset();
}

Result<VideoPacket> VideoEncoder::encode(std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality,
                                         bool want_key) {
  if (!state_ || state_->size_px != size_px) {
    auto state = std::make_unique<State>(size_px);
    if (const Status opened = state->open(quality); !opened) return opened.error();
    state_ = std::move(state);
  }
  state_->set_quality(quality);
  if (const Status encoded = state_->encode(rgbx, next_index_, want_key); !encoded) {
    rest();  // whatever comes next begins anew
    return encoded.error();
  }
  const AVPacket& packet = *state_->packet;
  VideoPacket result{next_index_++, (packet.flags & AV_PKT_FLAG_KEY) != 0,
                     std::make_shared<const std::vector<std::uint8_t>>(packet.data, packet.data + packet.size)};
  av_packet_unref(state_->packet.get());
  return result;
}

}  // namespace lightwell
