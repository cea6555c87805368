#include "server/video/codecs/libav.h"

namespace lightwell::video_codecs {

bool can_encode() {
  av_log_set_level(AV_LOG_ERROR);  // the program's log is its own
  return avcodec_find_encoder_by_name(libav::kEncoder) != nullptr;
}

}  // namespace lightwell::video_codecs

const lightwell::video_codecs::Table* lightwell_video_codecs() {
  using namespace lightwell;
  static const video_codecs::Table table{&video_codecs::can_encode, &video_codecs::open_packets,
                                         &video_codecs::open_film};
  return &table;
}
