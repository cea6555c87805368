// Code that brings many libraries, in a module beside the program that is loaded when it is first needed.
#pragma once

#include "renderer/error.h"

namespace lightwell {

/// The address of a module's one function. The module stays. kInternal names the module and says why it cannot be had:
/// it belongs to the program, and lies beside it or where libraries are (CMAKE_BUILD_RPATH).
Result<void*> load_module_function(const char* module, const char* function);

}  // namespace lightwell
