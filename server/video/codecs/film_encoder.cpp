extern "C" {
#include <libavformat/avformat.h>
}

#include <algorithm>
#include <cmath>

#include "server/video/codecs/libav.h"

namespace lightwell::video_codecs {
namespace {

constexpr int kFinestRate = 1'000'000;  // the denominator of pictures a second
constexpr double kKeysApartS = 2.0;     // a player can begin anywhere so; what is between two keys is held as packets
constexpr int kBufferBytes = 64 << 10;

struct CloseFile {
  void operator()(AVFormatContext* context) const { avformat_free_context(context); }
  void operator()(AVIOContext* file) const {
    av_freep(&file->buffer);
    avio_context_free(&file);
  }
};

/// Fragments, so that nothing has to be gone back to; no time of making and no names of libraries in it, and one
/// thread: the same pictures give the same bytes.
class Mp4Film : public FilmEncoder {
 public:
  Status open(glm::ivec2 size_px, double fps) {
    context_ = libav::encoder_context(size_px);
    packet_.reset(av_packet_alloc());
    if (!context_ || !packet_) return Error{ErrorKind::kUnsupported, "libavcodec", "no H.264 encoder can be had"};
    const AVRational rate = av_d2q(fps, kFinestRate);
    context_->framerate = rate;
    context_->time_base = av_inv_q(rate);
    context_->gop_size = static_cast<int>(std::clamp(std::round(fps * kKeysApartS), 1.0, 250.0));
    context_->max_b_frames = 0;
    context_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
    // Pictures looked ahead are pictures held.
    const bool set = libav::set_option(*context_, "preset", "faster") &&
                     libav::set_option(*context_, "profile", "high") && libav::set_option(*context_, "crf", "17") &&
                     libav::set_option(*context_, "x264-params", "rc-lookahead=8:sync-lookahead=0");
    if (!set) return Error{ErrorKind::kUnsupported, "libavcodec", "the H.264 encoder is another than libx264"};
    if (const int code = avcodec_open2(context_.get(), nullptr, nullptr); code < 0)
      return libav::failure("the encoder does not open", code);
    if (const Status opened = open_file(); !opened) return opened;
    return picture_.open(size_px);
  }

  Result<std::string> add(std::span<const std::uint8_t> rgbx) override {
    if (const Status converted = picture_.convert(rgbx); !converted) return converted.error();
    picture_.frame()->pts = next_++;
    if (const Status encoded = encode(picture_.frame()); !encoded) return encoded.error();
    return taken();
  }

  Result<std::string> finish() override {
    if (const Status encoded = encode(nullptr); !encoded) return encoded.error();
    if (const int code = av_write_trailer(format_.get()); code < 0)
      return libav::failure("the file does not end", code);
    return taken();
  }

 private:
  Status open_file() {
    auto* buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
    const auto write = [](void* self, auto* bytes, int size) {
      static_cast<Mp4Film*>(self)->written_.append(reinterpret_cast<const char*>(bytes),
                                                   static_cast<std::size_t>(size));
      return size;
    };
    if (buffer) file_.reset(avio_alloc_context(buffer, kBufferBytes, 1, this, nullptr, write, nullptr));
    AVFormatContext* format = nullptr;
    avformat_alloc_output_context2(&format, nullptr, "mp4", nullptr);
    format_.reset(format);
    stream_ = format ? avformat_new_stream(format, nullptr) : nullptr;
    if (!file_ || !stream_) return libav::failure("no file", AVERROR(ENOMEM));
    format->pb = file_.get();
    format->flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;
    stream_->time_base = context_->time_base;
    stream_->avg_frame_rate = context_->framerate;
    int code = avcodec_parameters_from_context(stream_->codecpar, context_.get());
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "empty_moov+default_base_moof+frag_keyframe", 0);
    if (code >= 0) code = avformat_write_header(format, &options);
    av_dict_free(&options);
    if (code < 0) return libav::failure("the file does not begin", code);
    return Done{};
  }

  /// `frame` null: what the encoder still holds.
  Status encode(const AVFrame* frame) {
    int code = avcodec_send_frame(context_.get(), frame);
    while (code >= 0) {
      code = avcodec_receive_packet(context_.get(), packet_.get());
      if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return Done{};
      if (code < 0) break;
      packet_->stream_index = stream_->index;
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), context_->time_base, stream_->time_base);
      code = av_write_frame(format_.get(), packet_.get());
      av_packet_unref(packet_.get());
    }
    return libav::failure("a picture does not encode", code);
  }

  std::string taken() {
    avio_flush(file_.get());
    return std::exchange(written_, std::string());
  }

  libav::Owned<AVCodecContext> context_;
  libav::Owned<AVPacket> packet_;
  libav::ConvertedPicture picture_;
  std::string written_;
  std::unique_ptr<AVIOContext, CloseFile> file_;
  std::unique_ptr<AVFormatContext, CloseFile> format_;
  AVStream* stream_ = nullptr;  // of the format
  std::int64_t next_ = 0;
};

}  // namespace

Result<std::unique_ptr<FilmEncoder>> open_film(glm::ivec2 size_px, double fps) {
  auto film = std::make_unique<Mp4Film>();
  if (const Status opened = film->open(size_px, fps); !opened) return opened.error();
  return std::unique_ptr<FilmEncoder>(std::move(film));
}

}  // namespace lightwell::video_codecs
