// What all that uses libavcodec's family shares: ownership, errors, and pictures in the form that video has.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libswscale/swscale.h>
}

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "server/video/codecs/codecs.h"

namespace lightwell::libav {

inline constexpr const char* kEncoder = "libx264";

struct Free {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

/// `code`: what a function of the libraries returned, below 0.
Error failure(const char* what, int code);

/// An H.264 encoder to be opened, of pictures as ConvertedPicture makes them, said to be so in the stream. One thread:
/// the same pictures give the same bytes, and the renderer wants the others. Null: no memory, or no such encoder.
Owned<AVCodecContext> encoder_context(glm::ivec2 size_px);

/// Sets an encoder's own option; false if it knows none of that name, or not that value.
bool set_option(AVCodecContext& context, const char* name, const char* value);

/// A picture as video has it: BT.709 in limited range, chroma halved, with sRGB's transfer function as it came.
class ConvertedPicture {
 public:
  /// Sides are even.
  Status open(glm::ivec2 size_px);
  /// `rgbx`: 4 bytes a pixel of sRGB, row 0 at the top.
  Status convert(std::span<const std::uint8_t> rgbx);
  AVFrame* frame() { return frame_.get(); }

 private:
  glm::ivec2 size_px_{};
  Owned<AVFrame> frame_;
  Owned<SwsContext> converter_;
};

}  // namespace lightwell::libav
