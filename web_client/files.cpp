#include "web_client/files.h"

#include "web_client/embedded.h"

namespace lightwell {

const std::map<std::string, WebFile, std::less<>>& web_files() {
  static const auto files = [] {
    std::map<std::string, WebFile, std::less<>> table;
    for (const EmbeddedFile& file : embedded_web_files()) {
      const std::string_view bytes(reinterpret_cast<const char*>(file.bytes), file.size);
      table.emplace(file.path, WebFile{bytes, content_type_of(file.path)});
    }
    return table;
  }();
  return files;
}

std::string_view content_type_of(std::string_view path) {
  struct Ending {
    std::string_view text;
    std::string_view content_type;
  };
  constexpr Ending kEndings[] = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".ico", "image/x-icon"},
  };
  for (const Ending& ending : kEndings) {
    if (path.ends_with(ending.text)) return ending.content_type;
  }
  return {};
}

}  // namespace lightwell
