// What a client may do, as its token says.
#pragma once

#include <optional>
#include <string_view>

namespace lightwell {

/// What an operation asks for. A token's scopes are a set of these; a wider one brings the narrower ones along.
enum class Scope : unsigned {
  kPublic = 0,  // anyone: the viewer's files, health, the OpenAPI document
  kView = 1,    // look: scenes, sessions, pictures of them, streams that only watch
  kDrive = 2,   // and have pictures made: sessions, inputs, renderings, sequences; brings view
  kUpload = 4,  // and bring scenes; brings view
  kAdmin = 8,   // and see how the server does; brings all others
};

/// A set of scopes.
class Scopes {
 public:
  constexpr Scopes() = default;
  constexpr Scopes(Scope scope) { add(scope); }
  static constexpr Scopes all() { return Scopes(Scope::kAdmin); }

  constexpr void add(Scope scope) {
    bits_ |= static_cast<unsigned>(scope);
    if (scope == Scope::kAdmin) bits_ |= 7u;
    if (scope == Scope::kDrive || scope == Scope::kUpload) bits_ |= 1u;
  }
  constexpr bool has(Scope scope) const {
    return (bits_ & static_cast<unsigned>(scope)) == static_cast<unsigned>(scope);
  }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr bool operator==(const Scopes&) const = default;

 private:
  unsigned bits_ = 0;
};

/// "view", "drive", "upload" or "admin"; "public" for what needs none.
constexpr std::string_view name_of(Scope scope) {
  switch (scope) {
    case Scope::kView:
      return "view";
    case Scope::kDrive:
      return "drive";
    case Scope::kUpload:
      return "upload";
    case Scope::kAdmin:
      return "admin";
    case Scope::kPublic:
      break;
  }
  return "public";
}

constexpr std::optional<Scope> scope_from_name(std::string_view name) {
  for (const Scope scope : {Scope::kView, Scope::kDrive, Scope::kUpload, Scope::kAdmin})
    if (name_of(scope) == name) return scope;
  return std::nullopt;
}

}  // namespace lightwell
