#include "server/video/load_codecs.h"

#if defined(LIGHTWELL_HAS_VIDEO) && !defined(LIGHTWELL_VIDEO_LINKED)
#include <dlfcn.h>
#endif

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
// Beside the program, or where libraries are: see CMAKE_BUILD_RPATH.
constexpr const char* kModule = "liblightwell_video_codecs.so";

Result<const video_codecs::Table*> load() {
  void* module = dlopen(kModule, RTLD_LAZY | RTLD_LOCAL);
  void* symbol = module ? dlsym(module, "lightwell_video_codecs") : nullptr;
  if (!symbol) return Error{ErrorKind::kUnsupported, kModule, std::string("cannot be loaded: ") + dlerror()};
  return reinterpret_cast<decltype(&lightwell_video_codecs)>(symbol)();
}
#endif

}  // namespace

Result<const video_codecs::Table*> video_codecs_table() {
  static const Result<const video_codecs::Table*> table = load();
  return table;
}

}  // namespace lightwell
