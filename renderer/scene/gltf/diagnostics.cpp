#include "renderer/scene/gltf/diagnostics.h"

#include <cstdio>

namespace lightwell::gltf {

void fail(std::string where, std::string what, ErrorKind kind) {
  throw Failure(Error{kind, std::move(where), std::move(what)});
}

std::string join(std::string_view parent, std::string_view child) {
  std::string path(parent);
  if (!path.empty()) path += '/';
  return path.append(child);
}

std::string join(std::string_view parent, std::size_t child) {
  return join(parent, std::to_string(child));
}

std::string readable(std::string_view text, std::size_t longest) {
  std::string result;
  for (const char character : text.substr(0, longest)) {
    const auto code = static_cast<unsigned char>(character);
    result += code < 0x20 || code == 0x7f ? '?' : character;
  }
  if (text.size() <= longest) return result;
  // The cut may fall within a character of several bytes; what is left of it is dropped.
  while (!result.empty() && (static_cast<unsigned char>(result.back()) & 0xc0) == 0x80) result.pop_back();
  if (!result.empty() && static_cast<unsigned char>(result.back()) >= 0xc0) result.pop_back();
  return result + "...";
}

std::string in_quotes(std::string_view text) {
  return "'" + readable(text, 80) + "'";
}

std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

void Warnings::add(std::string_view where, std::string_view what) {
  constexpr std::size_t kMost = 100;
  if (messages_.size() >= kMost) {
    ++left_out_;
    return;
  }
  std::string message(where);
  if (!message.empty()) message += ": ";
  messages_.push_back(message.append(what));
}

void Warnings::add_once(std::string_view where, std::string_view what) {
  if (said_.emplace(what).second) add(where, what);
}

std::vector<std::string> Warnings::take() {
  if (left_out_ > 0) messages_.push_back("and " + std::to_string(left_out_) + " more warnings");
  left_out_ = 0;
  said_.clear();
  return std::exchange(messages_, {});
}

}  // namespace lightwell::gltf
