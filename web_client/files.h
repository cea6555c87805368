// The viewer's files, built into the binary.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace lightwell {

struct WebFile {
  std::string_view bytes;         // lives as long as the program
  std::string_view content_type;  // with charset where it is text
};

/// By path relative to the viewer's folder: "index.html", "protocol.js", ...
const std::map<std::string, WebFile, std::less<>>& web_files();

/// The content type that a file's ending stands for; empty if the viewer has no business with such a file.
std::string_view content_type_of(std::string_view path);

}  // namespace lightwell
