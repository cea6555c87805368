#include "server/http/message.h"

#include <cstdlib>
#include <ctime>

namespace lightwell::http {
namespace {

/// RFC 9110, 5.6.7: Sun, 06 Nov 1994 08:49:37 GMT.
std::string http_date() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  char text[40];
  std::snprintf(text, sizeof(text), "%s, %02d %s %04d %02d:%02d:%02d GMT", kDays[parts.tm_wday], parts.tm_mday,
                kMonths[parts.tm_mon], parts.tm_year + 1900, parts.tm_hour, parts.tm_min, parts.tm_sec);
  return text;
}

}  // namespace

Response json_response(int status, const nlohmann::json& value) {
  return {status, "application/json", protocol::json_text(value), {}};
}

Response problem_response(const protocol::Problem& problem) {
  Response response{problem.status, "application/problem+json", protocol::json_text(protocol::to_json(problem)), {}};
  if (problem.status == 503 || problem.status == 429) response.headers.emplace_back("Retry-After", "1");
  return response;
}

Response refusal_response(const net::Refusal& refusal) {
  Response response = problem_response(protocol::make_problem(refusal.status, refusal.detail));
  for (const auto& field : refusal.fields) {
    std::erase_if(response.headers, [&](const auto& known) { return known.first == field.first; });
    response.headers.push_back(field);
  }
  return response;
}

std::string wire_format(const Response& response, bool keep_alive, const Fields& more) {
  std::string text = "HTTP/1.1 " + std::to_string(response.status) + " ";
  text += protocol::status_phrase(response.status);
  text += "\r\n";
  const auto add = [&](const std::string& name, const std::string& value) {
    text.append(name).append(": ").append(value).append("\r\n");
  };
  for (const auto& [name, value] : common_headers()) add(name, value);
  for (const auto& [name, value] : response.headers) add(name, value);
  for (const auto& [name, value] : more) add(name, value);
  if (!response.content_type.empty()) add("Content-Type", response.content_type);
  if (response.status != 204) add("Content-Length", std::to_string(response.body.size()));
  if (!keep_alive) add("Connection", "close");
  return text + "\r\n" + response.body;
}

int status_of(std::string_view response) {
  constexpr std::string_view kStart = "HTTP/1.1 ";
  if (!response.starts_with(kStart) || response.size() < kStart.size() + 3) return 0;
  return std::atoi(std::string(response.substr(kStart.size(), 3)).c_str());
}

Fields common_headers() {
  return {{"Date", http_date()},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"}};
}

}  // namespace lightwell::http
