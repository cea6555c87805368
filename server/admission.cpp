// Who may ask what, decided by a request's head before any of its body is read.
#include <algorithm>

#include "server/service_state.h"

namespace lightwell {
namespace {

using net::Refusal;

/// The stream's session id, if `path` is that of a stream.
std::optional<std::string> session_of_stream(std::string_view path) {
  constexpr std::string_view kBefore = "/v1/sessions/", kAfter = "/stream";
  if (!http::matches("/v1/sessions/{id}/stream", path)) return {};
  return std::string(path.substr(kBefore.size(), path.size() - kBefore.size() - kAfter.size()));
}

bool lists_subprotocol(std::string_view list) {
  while (!list.empty()) {
    const auto comma = std::min(list.find(','), list.size());
    std::string_view item = list.substr(0, comma);
    while (item.starts_with(' ')) item.remove_prefix(1);
    while (item.ends_with(' ')) item.remove_suffix(1);
    if (item == protocol::kSubprotocol) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

Refusal refusal_of(const protocol::Problem& problem) {
  return {problem.status, problem.detail, {}};
}

}  // namespace

Refusal busy(std::string detail) {
  return {503, std::move(detail), {{"Retry-After", "1"}}};
}

std::optional<std::string> Service::State::path_below_base(const std::string& path) const {
  if (options.base_path.empty() || !path.starts_with(options.base_path)) return path;
  const std::string below = path.substr(options.base_path.size());
  if (below.empty()) return {};
  return below.starts_with('/') ? below : path;
}

std::optional<Refusal> Service::State::check_state(std::string_view path) const {
  const bool about_health = path == "/healthz" || path == "/readyz";
  if (draining && !about_health) return busy("the server is stopping");
  if (!scenes_loaded && path.starts_with("/v1/")) return busy("the scenes are being loaded");
  return {};
}

/// The scopes of the request's token, if they are enough for what it asks. `below` has its path below the base path.
std::variant<Scopes, Refusal> Service::State::check_access(const net::RequestHead& below,
                                                           const std::optional<std::string>& session_id) {
  if (session_id) return access.check_token(below, Scope::kView);
  if (access.is_preflight(below)) return access.check_token(below, Scope::kPublic);
  const auto found = routes.find(below);
  // Nothing is told of what a token would be needed for before there is one, but that it is needed.
  if (const auto* refusal = std::get_if<Refusal>(&found)) {
    const Scope needed = refusal->status == 404 || refusal->status == 405 ? Scope::kPublic : Scope::kView;
    auto scopes = access.check_token(below, needed);
    return std::holds_alternative<Refusal>(scopes) ? scopes : std::variant<Scopes, Refusal>(*refusal);
  }
  return access.check_token(below, std::get<const http::Route*>(found)->scope);
}

net::Admission Service::State::admit_stream(const net::RequestHead& head, const std::string& session_id,
                                            Scopes scopes) {
  if (!head.wants_web_socket)
    return Refusal{426, "a stream is a WebSocket", {{"Upgrade", "websocket"}, {"Connection", "Upgrade"}}};
  const std::string_view subprotocols = head.field("sec-websocket-protocol");
  const bool named = lists_subprotocol(subprotocols);
  if (!subprotocols.empty() && !named) return Refusal{400, "the WebSocket subprotocol spoken here is lightwell.v1", {}};
  const std::shared_ptr<Session> session = sessions.find(session_id);
  if (!session && sessions.keeps_sessions()) return net::HttpAdmission{};  // a worker looks whether it can be had
  if (!session) return refusal_of(no_such_session());
  auto viewer = session->open_stream(scopes.has(Scope::kDrive));
  if (!viewer) return refusal_of(viewer.problem());
  return net::WebSocketAdmission{std::move(viewer).value(),
                                 named ? std::string(protocol::kSubprotocol) : std::string()};
}

net::Admission Service::admit(const net::RequestHead& head, const net::Peer& peer) {
  const std::optional<std::string> path = state_->path_below_base(head.path);
  if (!path)
    return Refusal{308, "the viewer is at " + head.path + "/", {{"Location", state_->options.base_path + "/"}}};
  const bool about_health = *path == "/healthz" || *path == "/readyz";
  if (!about_health)
    if (auto refusal = state_->access.check_origin_and_rate(head, peer)) return *refusal;
  net::RequestHead below = head;
  below.path = *path;
  const auto session_id = head.method == "GET" ? session_of_stream(*path) : std::nullopt;
  const auto scopes = state_->check_access(below, session_id);
  if (const auto* refusal = std::get_if<Refusal>(&scopes)) return *refusal;
  if (state_->access.is_preflight(head)) return net::HttpAdmission{};
  if (auto refusal = state_->check_state(*path)) return *refusal;
  if (session_id) return state_->admit_stream(head, *session_id, std::get<Scopes>(scopes));
  return net::HttpAdmission{std::get<const http::Route*>(state_->routes.find(below))->max_body_bytes};
}

}  // namespace lightwell
