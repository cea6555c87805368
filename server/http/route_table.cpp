#include "server/http/route_table.h"

#include <algorithm>

namespace lightwell::http {
namespace {

using net::Refusal;

/// The first segment of a path, cut off it.
std::string_view take_segment(std::string_view& path) {
  path.remove_prefix(1);  // the slash
  const auto end = std::min(path.find('/'), path.size());
  const std::string_view segment = path.substr(0, end);
  path.remove_prefix(end);
  return segment;
}

/// "application/json; charset=utf-8" without its parameters, in lower case.
std::string media_type(std::string_view content_type) {
  std::string type(content_type.substr(0, content_type.find(';')));
  while (!type.empty() && (type.back() == ' ' || type.back() == '\t')) type.pop_back();
  for (char& c : type)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return type;
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : between).append(word);
  return text;
}

/// What is wrong with the body that a request announces, if anything.
std::variant<const Route*, Refusal> check_body(const Route& route, const net::RequestHead& head) {
  const bool has_body = head.framing == net::Framing::kChunked || head.content_length > 0;
  if (route.content_types.empty()) {
    if (has_body) return Refusal{413, route.method + " " + route.path + " takes no body", {}};
    return &route;
  }
  if (head.framing == net::Framing::kNone)
    return Refusal{411, "the request has neither Content-Length nor Transfer-Encoding", {}};
  const std::string type = media_type(head.field("content-type"));
  const auto& known = route.content_types;
  if (std::find(known.begin(), known.end(), type) == known.end())
    return Refusal{415, "the body must be " + joined(known, " or ") + ", not \"" + type + "\"", {}};
  if (head.content_length > route.max_body_bytes)
    return Refusal{413, "the body has more than " + std::to_string(route.max_body_bytes) + " bytes", {}};
  return &route;
}

}  // namespace

bool matches(std::string_view path_template, std::string_view path) {
  while (!path_template.empty() && !path.empty()) {
    const std::string_view wanted = take_segment(path_template);
    const std::string_view given = take_segment(path);
    const bool any = wanted.starts_with('{');
    if (any ? given.empty() : wanted != given) return false;
  }
  return path_template.empty() && path.empty();
}

std::variant<const Route*, Refusal> RouteTable::find(const net::RequestHead& head) const {
  const std::string_view method = head.method == "HEAD" ? "GET" : std::string_view(head.method);
  std::vector<std::string> allowed;
  for (const Route& route : routes_) {
    if (!head.path.starts_with('/') || !matches(route.path, head.path)) continue;
    if (route.method == method) return check_body(route, head);
    if (route.is_page && method == "POST") continue;
    allowed.push_back(route.method);
    if (route.method == "GET") allowed.push_back("HEAD");
  }
  if (allowed.empty())
    return Refusal{404, "there is nothing at " + head.path + (method == "POST" ? " to post to" : ""), {}};
  return Refusal{405, head.method + " is not allowed at " + head.path, {{"Allow", joined(allowed, ", ")}}};
}

}  // namespace lightwell::http
