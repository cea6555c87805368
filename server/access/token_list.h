// The bearer tokens that a server takes, and what each of them allows.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/error.h"
#include "server/access/scope.h"

namespace lightwell {

class TokenList {
 public:
  /// Lines of "SCOPE[,SCOPE...] TOKEN"; empty lines and those that begin with # are passed over. An error names the
  /// line, never the token.
  static Result<TokenList> parse(std::string_view text);
  /// kNotFound if the file cannot be read, kInvalidInput if it holds no token or a bad line.
  static Result<TokenList> read(const std::filesystem::path& path);

  /// Adds one. Bad: shorter than 16 or longer than 256 bytes, or not of A-Z a-z 0-9 - . _ ~ (what may stand in a header
  /// field, a WebSocket subprotocol and an address alike).
  Status add(std::string token, Scopes scopes);

  bool empty() const { return entries_.empty(); }
  /// What the token allows; nothing if it is not known. Takes the same time whichever token is tried.
  Scopes find(std::string_view token) const;

 private:
  struct Entry {
    std::string token;
    Scopes scopes;
  };
  std::vector<Entry> entries_;
};

}  // namespace lightwell
