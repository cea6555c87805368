#include "server/origin.h"

#include <algorithm>

namespace lightwell {
namespace {

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

bool origin_allowed(const net::RequestHead& head, const std::vector<std::string>& allowed) {
  const std::string_view origin = head.field("origin");
  const bool only_reads = (head.method == "GET" || head.method == "HEAD") && !head.wants_web_socket;
  if (origin.empty() || only_reads) return true;
  if (std::find(allowed.begin(), allowed.end(), origin) != allowed.end()) return true;
  const auto scheme_end = origin.find("://");
  return scheme_end != std::string_view::npos && equal_ignoring_case(origin.substr(scheme_end + 3), head.field("host"));
}

}  // namespace lightwell
