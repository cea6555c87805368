#include "server/access/token_list.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace lightwell {
namespace {

constexpr std::size_t kShortestToken = 16, kLongestToken = 256;

bool is_token_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' ||
         c == '_' || c == '~';
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const auto begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

/// The text up to `end`, which is taken off with it.
std::string_view take_until(std::string_view& text, std::string_view ends) {
  const auto end = std::min(text.find_first_of(ends), text.size());
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return taken;
}

Result<Scopes> parse_scopes(std::string_view list) {
  Scopes scopes;
  while (!list.empty()) {
    const std::string_view name = take_until(list, ",");
    const auto scope = scope_from_name(name);
    if (!scope)
      return invalid_input("", "there is no scope \"" + std::string(name) + "\" (view, drive, upload, admin)");
    scopes.add(*scope);
  }
  return scopes;
}

/// As long as the given token is, whatever the known one.
bool equal_in_constant_time(std::string_view given, std::string_view known) {
  std::size_t difference = given.size() ^ known.size();
  for (std::size_t i = 0; i < given.size(); ++i)
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(known[i % known.size()]);
  return difference == 0;
}

}  // namespace

Status TokenList::add(std::string token, Scopes scopes) {
  if (token.size() < kShortestToken || token.size() > kLongestToken)
    return invalid_input("", "a token has 16 to 256 characters, not " + std::to_string(token.size()));
  if (!std::all_of(token.begin(), token.end(), is_token_character))
    return invalid_input("", "a token is of A-Z a-z 0-9 - . _ ~ alone");
  if (!find(token).empty()) return invalid_input("", "the token is given twice");
  entries_.push_back({std::move(token), scopes});
  return Done{};
}

Result<TokenList> TokenList::parse(std::string_view text) {
  TokenList list;
  for (int number = 1; !text.empty(); ++number) {
    std::string_view line = trimmed(take_until(text, "\n"));
    if (line.empty() || line.starts_with('#')) continue;
    const std::string where = "line " + std::to_string(number);
    const Result<Scopes> scopes = parse_scopes(take_until(line, " \t"));
    if (!scopes) return invalid_input(where, scopes.error().what);
    const Status added = list.add(std::string(trimmed(line)), *scopes);
    if (!added) return invalid_input(where, added.error().what);
  }
  if (list.empty()) return invalid_input("", "no token is in it");
  return list;
}

Result<TokenList> TokenList::read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{ErrorKind::kNotFound, path.string(), "cannot be read"};
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  Result<TokenList> list = parse(text);
  if (!list)
    return invalid_input(path.string() + (list.error().where.empty() ? "" : ", " + list.error().where),
                         list.error().what);
  return list;
}

Scopes TokenList::find(std::string_view token) const {
  Scopes found;
  for (const Entry& entry : entries_)
    if (equal_in_constant_time(token, entry.token)) found = entry.scopes;
  return found;
}

}  // namespace lightwell
