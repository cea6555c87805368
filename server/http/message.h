// Requests and responses as the handlers of routes see them.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/codec.h"
#include "server/net/request_head.h"

namespace lightwell::http {

struct Request {
  std::vector<std::string> path_parameters;                // of the route's {names}, in order
  std::vector<std::pair<std::string, std::string>> query;  // decoded
  std::string_view body;
  std::string_view if_none_match;
  std::shared_ptr<std::atomic<bool>> gone;  // the client has hung up
};

struct Response {
  int status = 200;
  std::string content_type;
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
};

Response json_response(int status, const nlohmann::json& value);
Response problem_response(const protocol::Problem& problem);
/// A refusal of the connection layer as a problem.
Response refusal_response(const net::Refusal& refusal);

/// The response as it goes over the wire, with the fields every response has.
std::string wire_format(const Response& response, bool keep_alive);

/// Fields that every response has, whoever writes it.
std::vector<std::pair<std::string, std::string>> common_headers();

}  // namespace lightwell::http
