// JSON pointers (RFC 6901).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/error.h"

namespace lightwell::object_model {

class Pointer {
 public:
  /// Refuses what is neither empty nor begins with a slash, and a ~ that neither 0 nor 1 follows.
  static Result<Pointer> parse(std::string text);

  const std::string& text() const { return text_; }
  std::size_t size() const { return tokens_.size(); }

  /// Unescaped; `i` is below size().
  const std::string& token(std::size_t i) const { return tokens_[i]; }

  /// The text before and from token `i`, up to and including size(): before(i) + from(i) == text().
  std::string before(std::size_t i) const { return text_.substr(0, offset(i)); }
  std::string from(std::size_t i) const { return text_.substr(offset(i)); }

 private:
  std::size_t offset(std::size_t i) const { return i < slashes_.size() ? slashes_[i] : text_.size(); }

  std::string text_;
  std::vector<std::string> tokens_;
  std::vector<std::size_t> slashes_;  // where each token's slash stands in `text_`
};

/// `name` as a token of a pointer: ~ becomes ~0 and / becomes ~1.
std::string escape_token(std::string_view name);

/// The index that a token is: digits without a leading zero, below 10^9. None: it is a name, or "-".
std::optional<std::size_t> index_of_token(std::string_view token);

}  // namespace lightwell::object_model
