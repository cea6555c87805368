#include "server/access/access_control.h"

#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

using net::Refusal;

constexpr std::string_view kBearerSubprotocol = "bearer.";
constexpr const char* kPreflightSeconds = "600";

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

/// "[::1]:8080" without its port.
std::string_view without_port(std::string_view host) {
  const auto bracket = host.rfind(']');
  const auto colon = host.rfind(':');
  const bool has_port = colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  return has_port ? host.substr(0, colon) : host;
}

/// "https://example.org:8443" without its scheme; empty if it has none.
std::string_view host_of_origin(std::string_view origin) {
  const auto scheme_end = origin.find("://");
  return scheme_end == std::string_view::npos ? std::string_view() : origin.substr(scheme_end + 3);
}

bool is_loopback_name(std::string_view host) {
  return equal_ignoring_case(host, "localhost") || host == "[::1]" || host.starts_with("127.");
}

Refusal unauthorized(std::string detail, const char* error) {
  const std::string challenge = "Bearer realm=\"lightwell\"";
  return {401, std::move(detail), {{"WWW-Authenticate", error ? challenge + ", error=\"" + error + "\"" : challenge}}};
}

}  // namespace

std::string_view bearer_token(const net::RequestHead& head) {
  const std::string_view authorization = head.field("authorization");
  constexpr std::string_view kScheme = "bearer ";
  if (authorization.size() > kScheme.size() && equal_ignoring_case(authorization.substr(0, kScheme.size()), kScheme))
    return authorization.substr(authorization.find_first_not_of(' ', kScheme.size() - 1));
  if (!head.wants_web_socket) return {};
  const std::string_view list = head.field("sec-websocket-protocol");
  const auto at = list.find(kBearerSubprotocol);
  const bool begins_item = at == 0 || (at != std::string_view::npos && (list[at - 1] == ' ' || list[at - 1] == ','));
  if (!begins_item) return {};
  const std::string_view rest = list.substr(at + kBearerSubprotocol.size());
  return rest.substr(0, std::min(rest.find_first_of(", "), rest.size()));
}

AccessControl::AccessControl(AccessOptions options)
    : options_(std::move(options)), rates_(options_.requests_per_second, options_.request_burst) {}

/// Without tokens everything rests on who can reach the port, and a page from anywhere can reach it under a name of its
/// own that it lets lead to this machine. Such a name is none of ours.
bool AccessControl::host_allowed(std::string_view host) const {
  if (has_tokens()) return true;
  const std::string_view name = without_port(host);
  const auto is_name = [&](std::string_view known) { return equal_ignoring_case(name, known); };
  return is_loopback_name(name) || host.empty() ||
         std::any_of(options_.allowed_hosts.begin(), options_.allowed_hosts.end(), is_name);
}

bool AccessControl::origin_listed(std::string_view origin) const {
  return std::find(options_.allowed_origins.begin(), options_.allowed_origins.end(), origin) !=
         options_.allowed_origins.end();
}

/// Good are: no Origin (no browser sent it, or it is a plain visit), that of the Host, and those on the list. Reading
/// methods other than streams need no leave: browsers keep the answer from foreign pages by themselves.
bool AccessControl::origin_allowed(const net::RequestHead& head) const {
  const std::string_view origin = head.field("origin");
  const bool only_reads = (head.method == "GET" || head.method == "HEAD") && !head.wants_web_socket;
  if (origin.empty() || only_reads || origin_listed(origin)) return true;
  const std::string_view host = host_of_origin(origin);
  return !host.empty() && equal_ignoring_case(host, head.field("host"));
}

std::optional<Refusal> AccessControl::check_origin_and_rate(const net::RequestHead& head, const net::Peer& peer) {
  if (!host_allowed(head.field("host")))
    return Refusal{421, "this server is not known as " + std::string(without_port(head.field("host"))), {}};
  if (!origin_allowed(head))
    return Refusal{403, "requests of pages from " + std::string(head.field("origin")) + " are not served", {}};
  // A token's holder is one client wherever it asks from; a guess at tokens is its address's.
  const std::string_view token = bearer_token(head);
  const bool known = !token.empty() && !options_.tokens.find(token).empty();
  const double wait_s =
      rates_.take(known ? "token " + std::string(token) : peer.address, std::chrono::steady_clock::now());
  if (wait_s <= 0.0) return {};
  const auto seconds = static_cast<long>(std::ceil(wait_s));
  return Refusal{429,
                 "more requests than one client may send (" +
                     std::to_string(std::lround(options_.requests_per_second)) + " a second)",
                 {{"Retry-After", std::to_string(seconds)}}};
}

std::variant<Scopes, Refusal> AccessControl::check_token(const net::RequestHead& head, Scope needed) const {
  if (!has_tokens()) return Scopes::all();
  const std::string_view token = bearer_token(head);
  const Scopes scopes = options_.tokens.find(token);
  if (needed == Scope::kPublic) return scopes;
  if (token.empty()) return unauthorized("this needs a bearer token", nullptr);
  if (scopes.empty()) return unauthorized("the bearer token is not known here", "invalid_token");
  if (scopes.has(needed)) return scopes;
  const std::string scope(name_of(needed));
  return Refusal{
      403,
      "this needs a token with the scope " + scope,
      {{"WWW-Authenticate", "Bearer realm=\"lightwell\", error=\"insufficient_scope\", scope=\"" + scope + "\""}}};
}

bool AccessControl::is_preflight(const net::RequestHead& head) const {
  return head.method == "OPTIONS" && origin_listed(head.field("origin")) &&
         !head.field("access-control-request-method").empty();
}

std::vector<std::pair<std::string, std::string>> AccessControl::answer_fields(const net::RequestHead& head) const {
  if (options_.allowed_origins.empty()) return {};
  std::vector<std::pair<std::string, std::string>> fields{{"Vary", "Origin"}};
  const std::string origin(head.field("origin"));
  if (!origin_listed(origin)) return fields;
  fields.emplace_back("Access-Control-Allow-Origin", origin);
  fields.emplace_back("Access-Control-Expose-Headers",
                      "ETag, Location, Retry-After, Server-Timing, X-Lightwell-Rays, X-Lightwell-Exposure-Ev, "
                      "X-Lightwell-Clamped-Share");
  return fields;
}

std::vector<std::pair<std::string, std::string>> AccessControl::preflight_fields() {
  return {{"Access-Control-Allow-Methods", "GET, HEAD, POST, PUT, PATCH, DELETE"},
          {"Access-Control-Allow-Headers", "Authorization, Content-Type, If-None-Match"},
          {"Access-Control-Max-Age", kPreflightSeconds}};
}

}  // namespace lightwell
