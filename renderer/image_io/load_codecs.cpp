#include "renderer/image_io/load_codecs.h"

#ifndef LIGHTWELL_CODECS_LINKED
#include <dlfcn.h>
#endif

namespace lightwell {

namespace {

#ifdef LIGHTWELL_CODECS_LINKED
Result<const codecs::Table*> load() {
  return lightwell_image_codecs();
}
#else
// Beside the program, or where libraries are: see CMAKE_BUILD_RPATH.
constexpr const char* kModule = "liblightwell_image_codecs.so";

Result<const codecs::Table*> load() {
  void* module = dlopen(kModule, RTLD_LAZY | RTLD_LOCAL);
  const auto failed = [] {
    return Error{ErrorKind::kInternal, kModule, std::string("cannot be loaded: ") + dlerror()};
  };
  if (!module) return failed();
  void* symbol = dlsym(module, "lightwell_image_codecs");
  if (!symbol) return failed();
  return reinterpret_cast<decltype(&lightwell_image_codecs)>(symbol)();
}
#endif

}  // namespace

Result<const codecs::Table*> image_codecs() {
  static const Result<const codecs::Table*> table = load();
  return table;
}

}  // namespace lightwell
