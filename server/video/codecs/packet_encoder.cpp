extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>

#include "server/video/codecs/libav.h"

namespace lightwell::video_codecs {
namespace {

constexpr AVRational kTimeBase{1, 60};  // of the numbers of pictures; nobody plays them by a clock

/// A constant rate factor that gives what moves as little error as a JPEG of that quality has, or less, in fewer bytes
/// (`helicopters`, 512 x 384, quality 80: 36.5 dB in 11.3 kB a picture; JPEG 35.7 dB in 13.7 kB).
double rate_factor(int quality) {
  return std::clamp(20.0 + (80 - quality) * 0.25, 16.0, 40.0);
}

class H264Packets : public PacketEncoder {
 public:
  Status open(glm::ivec2 size_px, int quality) {
    context_ = libav::encoder_context(size_px);
    packet_.reset(av_packet_alloc());
    if (!context_ || !packet_) return Error{ErrorKind::kUnsupported, "libavcodec", "no H.264 encoder can be had"};
    context_->time_base = kTimeBase;
    context_->max_b_frames = 0;
    const bool set =
        libav::set_option(*context_, "preset", "ultrafast") && libav::set_option(*context_, "tune", "zerolatency") &&
        libav::set_option(*context_, "profile", "baseline") &&
        libav::set_option(*context_, "x264-params", "keyint=infinite:scenecut=0") &&  // keys when asked for
        libav::set_option(*context_, "forced-idr", "1") && set_quality(quality);
    if (!set) return Error{ErrorKind::kUnsupported, "libavcodec", "the H.264 encoder is another than libx264"};
    if (const int code = avcodec_open2(context_.get(), nullptr, nullptr); code < 0)
      return libav::failure("the encoder does not open", code);
    return picture_.open(size_px);
  }

  Result<Packet> encode(std::span<const std::uint8_t> rgbx, int quality, bool want_key) override {
    set_quality(quality);
    if (const Status converted = picture_.convert(rgbx); !converted) return converted.error();
    picture_.frame()->pts = next_++;
    picture_.frame()->pict_type = want_key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
    int code = avcodec_send_frame(context_.get(), picture_.frame());
    if (code >= 0) code = avcodec_receive_packet(context_.get(), packet_.get());
    if (code < 0) return libav::failure("a picture does not encode", code);
    Packet result{(packet_->flags & AV_PKT_FLAG_KEY) != 0, {packet_->data, packet_->data + packet_->size}};
    av_packet_unref(packet_.get());
    return result;
  }

 private:
  bool set_quality(int quality) { return av_opt_set_double(context_->priv_data, "crf", rate_factor(quality), 0) >= 0; }

  libav::Owned<AVCodecContext> context_;
  libav::Owned<AVPacket> packet_;
  libav::ConvertedPicture picture_;
  std::int64_t next_ = 0;
};

}  // namespace

Result<std::unique_ptr<PacketEncoder>> open_packets(glm::ivec2 size_px, int quality) {
  auto encoder = std::make_unique<H264Packets>();
  if (const Status opened = encoder->open(size_px, quality); !opened) return opened.error();
  return std::unique_ptr<PacketEncoder>(std::move(encoder));
}

}  // namespace lightwell::video_codecs
