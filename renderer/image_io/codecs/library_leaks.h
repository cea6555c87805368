// Reading pictures in a program that a sanitizer watches for leaks.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIGHTWELL_LEAK_SANITIZER 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define LIGHTWELL_LEAK_SANITIZER 1
#endif
#ifdef LIGHTWELL_LEAK_SANITIZER
#include <sanitizer/lsan_interface.h>
#endif

namespace lightwell::codecs {

/// While it lives, a leak sanitizer passes over what this thread allocates: libpng leaves a broken file by a jump past
/// OpenImageIO's destructors, a message of 31 bytes each time. Without a sanitizer it is nothing.
class LibraryLeaks {
 public:
#ifdef LIGHTWELL_LEAK_SANITIZER
  LibraryLeaks() {
    __lsan_disable();
  }
  ~LibraryLeaks() {
    __lsan_enable();
  }
#else
  LibraryLeaks() {}
  ~LibraryLeaks() {}
#endif
  LibraryLeaks(const LibraryLeaks&) = delete;
  LibraryLeaks& operator=(const LibraryLeaks&) = delete;
};

}  // namespace lightwell::codecs
