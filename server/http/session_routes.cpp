#include "server/services.h"

#include <cmath>

namespace lightwell {
namespace {

using http::Request;
using http::Response;

constexpr std::uint64_t kMaxJsonBytes = 1u << 20;

Response no_such_session() {
  return http::problem_response(protocol::make_problem(404, "there is no such session, or it has ended"));
}

/// How long the session may stand idle: as asked for, if that is within what the server gives.
protocol::Decoded<double> idle_time(const protocol::SessionRequest& request, const ServeLimits& limits) {
  constexpr double kLeast = 1.0;  // how often anyone looks
  if (!request.idle_s) return limits.session_idle_s;
  if (*request.idle_s >= kLeast && *request.idle_s <= limits.session_idle_s) return *request.idle_s;
  const auto most = std::llround(limits.session_idle_s);
  return protocol::make_problem(422, "a session may stand idle for 1 to " + std::to_string(most) + " seconds",
                                "/idle_s");
}

Response create_session(const Services& services, std::string_view body) {
  const auto request = protocol::parse_session_request(body);
  if (!request) return http::problem_response(request.problem());
  const auto idle_s = idle_time(*request, services.options.limits);
  if (!idle_s) return http::problem_response(idle_s.problem());
  auto state = make_session_state(*request, services.surroundings.rules, std::chrono::steady_clock::now());
  if (!state) return http::problem_response(state.problem());
  const auto session = services.sessions.add(std::move(state).value(), services.surroundings, *idle_s);
  if (!session) return http::problem_response(session.problem());
  (*session)->begin();
  Response response = http::json_response(201, protocol::to_json((*session)->describe()));
  response.headers.emplace_back("Location", services.options.base_path + "/v1/sessions/" + (*session)->id());
  return response;
}

Response get_session(const Services& services, const std::string& id) {
  const std::shared_ptr<Session> session = services.sessions.find(id);
  if (!session) return no_such_session();
  return http::json_response(200, protocol::to_json(session->describe()));
}

Response patch_session(const Services& services, const std::string& id, std::string_view body) {
  const std::shared_ptr<Session> session = services.sessions.find(id);
  if (!session) return no_such_session();
  const auto patch = protocol::parse_session_patch(body);
  if (!patch) return http::problem_response(patch.problem());
  const auto changed = session->apply(*patch);
  if (!changed) return http::problem_response(changed.problem());
  return http::json_response(200, protocol::to_json(*changed));
}

Response delete_session(const Services& services, const std::string& id) {
  if (!services.sessions.end(id)) return no_such_session();
  return {204, {}, {}, {}};
}

}  // namespace

void add_session_routes(http::RouteTable& table, const Services& services) {
  using enum http::Effort;
  const std::vector<std::string> json{"application/json"};
  table.add({"POST", "/v1/sessions", Scope::kDrive, kQuick, kMaxJsonBytes, json,
             [&](const Request& request) { return create_session(services, request.body); }});
  table.add({"GET", "/v1/sessions/{id}", Scope::kView, kQuick, 0, {}, [&](const Request& request) {
               return get_session(services, request.path_parameters[0]);
             }});
  table.add({"PATCH", "/v1/sessions/{id}", Scope::kDrive, kQuick, kMaxJsonBytes, json, [&](const Request& request) {
               return patch_session(services, request.path_parameters[0], request.body);
             }});
  // Handshakes never come this far: the service admits them by itself.
  table.add({"GET", "/v1/sessions/{id}/stream", Scope::kView, kQuick, 0, {}, [](const Request&) {
               return http::problem_response(protocol::make_problem(426, "a stream is a WebSocket"));
             }});
  table.add({"DELETE", "/v1/sessions/{id}", Scope::kDrive, kQuick, 0, {}, [&](const Request& request) {
               return delete_session(services, request.path_parameters[0]);
             }});
}

}  // namespace lightwell
