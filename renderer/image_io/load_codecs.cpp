#include "renderer/image_io/load_codecs.h"

#include "renderer/modules/load_module.h"

namespace lightwell {

namespace {

#ifdef LIGHTWELL_CODECS_LINKED
Result<const codecs::Table*> load() {
  return lightwell_image_codecs();
}
#else
Result<const codecs::Table*> load() {
  const auto function = load_module_function("liblightwell_image_codecs.so", "lightwell_image_codecs");
  if (!function) return function.error();
  return reinterpret_cast<decltype(&lightwell_image_codecs)>(*function)();
}
#endif

}  // namespace

Result<const codecs::Table*> image_codecs() {
  static const Result<const codecs::Table*> table = load();
  return table;
}

}  // namespace lightwell
