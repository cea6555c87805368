// H.264 back to pictures, by libavcodec, as a client would.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
}

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace lightwell::test {

struct DecodedPicture {
  int width = 0, height = 0;
  std::vector<double> rgb;  // 3 a pixel, 0..255, by the matrix of BT.709 in limited range
  AVColorRange range{};
  AVColorSpace matrix{};
  AVColorPrimaries primaries{};
  AVColorTransferCharacteristic transfer{};

  std::array<double, 3> at(int x, int y) const {
    const auto first = static_cast<std::size_t>((y * width + x) * 3);
    return {rgb[first], rgb[first + 1], rgb[first + 2]};
  }
};

/// ITU-R BT.709-6, 3.2 to 3.5, with 8 bits.
inline DecodedPicture picture_of(const AVFrame& frame) {
  DecodedPicture picture{frame.width,           frame.height,   {}, frame.color_range, frame.colorspace,
                         frame.color_primaries, frame.color_trc};
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const double luma = (frame.data[0][y * frame.linesize[0] + x] - 16) / 219.0;
      const double blue = (frame.data[1][y / 2 * frame.linesize[1] + x / 2] - 128) / 224.0;
      const double red = (frame.data[2][y / 2 * frame.linesize[2] + x / 2] - 128) / 224.0;
      const double r = luma + 1.5748 * red;
      const double b = luma + 1.8556 * blue;
      const double g = (luma - 0.2126 * r - 0.0722 * b) / 0.7152;
      for (const double value : {r, g, b}) picture.rgb.push_back(std::clamp(value, 0.0, 1.0) * 255.0);
    }
  return picture;
}

class VideoDecoder {
 public:
  VideoDecoder() : context_(avcodec_alloc_context3(avcodec_find_decoder(AV_CODEC_ID_H264))), frame_(av_frame_alloc()) {
    context_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    EXPECT_EQ(avcodec_open2(context_, nullptr, nullptr), 0);
  }
  ~VideoDecoder() {
    av_frame_free(&frame_);
    avcodec_free_context(&context_);
  }
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  /// None if the packet does not give a picture at once.
  std::optional<DecodedPicture> decode(std::string_view bytes) {
    std::vector<std::uint8_t> padded(bytes.begin(), bytes.end());
    padded.resize(bytes.size() + AV_INPUT_BUFFER_PADDING_SIZE);
    AVPacket* packet = av_packet_alloc();
    packet->data = padded.data();
    packet->size = static_cast<int>(bytes.size());
    const bool decoded = avcodec_send_packet(context_, packet) == 0 && avcodec_receive_frame(context_, frame_) == 0;
    av_packet_free(&packet);
    if (!decoded) return {};
    return picture_of(*frame_);
  }
  std::optional<DecodedPicture> decode(const std::vector<std::uint8_t>& bytes) {
    return decode(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }

 private:
  AVCodecContext* context_;
  AVFrame* frame_;
};

/// In decibels, over all channels; `rgbx` has 4 bytes a pixel.
inline double psnr(const DecodedPicture& picture, const std::vector<std::uint8_t>& rgbx) {
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    const double difference = picture.rgb[i] - rgbx[i / 3 * 4 + i % 3];
    sum += difference * difference;
  }
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(picture.rgb.size()) / sum);
}

}  // namespace lightwell::test
