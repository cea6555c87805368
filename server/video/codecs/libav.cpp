#include "server/video/codecs/libav.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <cstring>
#include <string>

#include "renderer/check.h"

namespace lightwell::libav {
namespace {

constexpr AVPixelFormat kFormat = AV_PIX_FMT_YUV420P;
// Chroma as the mean of its four pixels, rounded without a bias; it is the fastest as well.
constexpr int kScaling = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP;

}  // namespace

Error failure(const char* what, int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(code, text, sizeof(text));
  return Error{ErrorKind::kInternal, "libavcodec", std::string(what) + ": " + text};
}

Owned<AVCodecContext> encoder_context(glm::ivec2 size_px) {
  const AVCodec* codec = avcodec_find_encoder_by_name(kEncoder);
  Owned<AVCodecContext> context(codec ? avcodec_alloc_context3(codec) : nullptr);
  if (!context) return context;
  context->width = size_px.x;
  context->height = size_px.y;
  context->pix_fmt = kFormat;
  context->color_range = AVCOL_RANGE_MPEG;
  context->colorspace = AVCOL_SPC_BT709;
  context->color_primaries = AVCOL_PRI_BT709;
  context->color_trc = AVCOL_TRC_IEC61966_2_1;
  context->thread_count = 1;
  return context;
}

bool set_option(AVCodecContext& context, const char* name, const char* value) {
  return av_opt_set(context.priv_data, name, value, 0) >= 0;
}

Status ConvertedPicture::open(glm::ivec2 size_px) {
  size_px_ = size_px;
  frame_.reset(av_frame_alloc());
  converter_.reset(sws_getContext(size_px.x, size_px.y, AV_PIX_FMT_RGB0, size_px.x, size_px.y, kFormat, kScaling,
                                  nullptr, nullptr, nullptr));
  if (!frame_ || !converter_) return failure("no picture", AVERROR(ENOMEM));
  frame_->format = kFormat;
  frame_->width = size_px.x;
  frame_->height = size_px.y;
  if (const int code = av_frame_get_buffer(frame_.get(), 0); code < 0) return failure("no picture", code);
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  const int code = sws_setColorspaceDetails(converter_.get(), bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
  if (code < 0) return failure("no conversion", code);
  return Done{};
}

Status ConvertedPicture::convert(std::span<const std::uint8_t> rgbx) {
  LIGHTWELL_CHECK_OP(rgbx.size(), ==, static_cast<std::size_t>(size_px_.x) * static_cast<std::size_t>(size_px_.y) * 4);
  if (const int code = av_frame_make_writable(frame_.get()); code < 0) return failure("no picture", code);
  const std::uint8_t* planes[] = {rgbx.data()};
  const int strides[] = {4 * size_px_.x};
  const int rows = sws_scale(converter_.get(), planes, strides, 0, size_px_.y, frame_->data, frame_->linesize);
  if (rows < 0) return failure("no conversion", rows);
  return Done{};
}

}  // namespace lightwell::libav
