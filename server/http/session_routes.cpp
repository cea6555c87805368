#include "server/services.h"

#include <cmath>

namespace lightwell {
namespace {

using http::Request;
using http::Response;

constexpr std::uint64_t kMaxJsonBytes = 1u << 20;

std::string address_of(const Services& services, const Session& session) {
  return services.options.base_path + "/v1/sessions/" + session.id();
}

/// Says where the session is, by which a balancer learns which server has it.
Response describe(const Services& services, const Session& session) {
  Response response = http::json_response(200, protocol::to_json(session.describe()));
  response.headers.emplace_back("Content-Location", address_of(services, session));
  return response;
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
  response.headers.emplace_back("Location", address_of(services, **session));
  return response;
}

Response get_session(const Services& services, const std::string& id) {
  const auto session = services.sessions.find_or_take_up(id, services.surroundings);
  return session ? describe(services, **session) : http::problem_response(session.problem());
}

Response patch_session(const Services& services, const std::string& id, std::string_view body) {
  const auto session = services.sessions.find_or_take_up(id, services.surroundings);
  if (!session) return http::problem_response(session.problem());
  const auto patch = protocol::parse_session_patch(body);
  if (!patch) return http::problem_response(patch.problem());
  if (const auto problem = (*session)->apply(*patch)) return http::problem_response(*problem);
  services.sessions.keep(**session);
  return describe(services, **session);
}

Response delete_session(const Services& services, const std::string& id) {
  const auto session = services.sessions.find_or_take_up(id, services.surroundings);
  if (!session) return http::problem_response(session.problem());
  services.sessions.end(id);
  return {204, {}, {}, {}};
}

/// A handshake comes this far if its session is not here: workers may take it up, but open no WebSocket.
Response take_up_for_stream(const Services& services, const std::string& id) {
  const auto session = services.sessions.find_or_take_up(id, services.surroundings);
  if (!session) return http::problem_response(session.problem());
  Response response =
      http::problem_response(protocol::make_problem(503, "the session has just come here; open its stream again"));
  response.headers.emplace_back("Content-Location", address_of(services, **session));
  return response;
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
  table.add({"GET", "/v1/sessions/{id}/stream", Scope::kView, kQuick, 0, {}, [&](const Request& request) {
               return take_up_for_stream(services, request.path_parameters[0]);
             }});
  table.add({"DELETE", "/v1/sessions/{id}", Scope::kDrive, kQuick, 0, {}, [&](const Request& request) {
               return delete_session(services, request.path_parameters[0]);
             }});
}

}  // namespace lightwell
