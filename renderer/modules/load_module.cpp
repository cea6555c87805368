#include "renderer/modules/load_module.h"

#include <dlfcn.h>

namespace lightwell {

Result<void*> load_module_function(const char* module, const char* function) {
  void* handle = dlopen(module, RTLD_LAZY | RTLD_LOCAL);
  void* address = handle ? dlsym(handle, function) : nullptr;
  if (!address) return Error{ErrorKind::kInternal, module, std::string("cannot be loaded: ") + dlerror()};
  return address;
}

}  // namespace lightwell
