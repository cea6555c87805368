#include "renderer/scene/gltf/object_model/pointer.h"

namespace lightwell::object_model {

Result<Pointer> Pointer::parse(std::string text) {
  if (!text.empty() && text.front() != '/') return invalid_input(text, "is no JSON pointer: it begins with no slash");
  Pointer pointer;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '/') {
      pointer.slashes_.push_back(i);
      pointer.tokens_.emplace_back();
    } else if (text[i] != '~') {
      pointer.tokens_.back() += text[i];
    } else {
      const char next = i + 1 < text.size() ? text[i + 1] : '\0';
      if (next != '0' && next != '1') return invalid_input(text, "is no JSON pointer: a ~ without 0 or 1");
      pointer.tokens_.back() += next == '0' ? '~' : '/';
      ++i;
    }
  }
  pointer.text_ = std::move(text);
  return pointer;
}

std::string escape_token(std::string_view name) {
  std::string token;
  for (const char letter : name) {
    if (letter == '~')
      token += "~0";
    else if (letter == '/')
      token += "~1";
    else
      token += letter;
  }
  return token;
}

std::optional<std::size_t> index_of_token(std::string_view token) {
  if (token.empty() || token.size() > 9 || (token.size() > 1 && token.front() == '0')) return std::nullopt;
  std::size_t index = 0;
  for (const char digit : token) {
    if (digit < '0' || digit > '9') return std::nullopt;
    index = index * 10 + static_cast<std::size_t>(digit - '0');
  }
  return index;
}

}  // namespace lightwell::object_model
