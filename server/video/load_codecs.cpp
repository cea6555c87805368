#include "server/video/load_codecs.h"

#include "renderer/modules/load_module.h"

namespace lightwell {
namespace {

#if !defined(LIGHTWELL_HAS_VIDEO)
Result<const video_codecs::Table*> load() {
  return Error{ErrorKind::kUnsupported, "video", "this build is without libavcodec"};
}
#elif defined(LIGHTWELL_VIDEO_LINKED)
Result<const video_codecs::Table*> load() {
  return lightwell_video_codecs();
}
#else
Result<const video_codecs::Table*> load() {
  const auto function = load_module_function("liblightwell_video_codecs.so", "lightwell_video_codecs");
  if (!function) return function.error();
  return reinterpret_cast<decltype(&lightwell_video_codecs)>(*function)();
}
#endif

}  // namespace

Result<const video_codecs::Table*> video_codecs_table() {
  static const Result<const video_codecs::Table*> table = load();
  return table;
}

}  // namespace lightwell
