// What cmake/embed_files.cmake generates; for files.cpp alone.
#pragma once

#include <cstddef>
#include <vector>

namespace lightwell {

struct EmbeddedFile {
  const char* path;
  const unsigned char* bytes;
  std::size_t size;
};

std::vector<EmbeddedFile> embedded_web_files();

}  // namespace lightwell
