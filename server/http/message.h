// Requests and responses as the handlers of routes see them.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/codec.h"
#include "server/net/application.h"

namespace lightwell::http {

struct Request {
  std::vector<std::string> path_parameters;                // of the route's {names}, in order
  std::vector<std::pair<std::string, std::string>> query;  // decoded
  std::string_view body;
  std::string_view if_none_match;
  std::shared_ptr<std::atomic<bool>> gone;  // the client has hung up
};

using Fields = std::vector<std::pair<std::string, std::string>>;

struct Response {
  int status = 200;
  std::string content_type;
  std::string body;
  Fields headers;
  std::shared_ptr<net::BodySource> rest = nullptr;  // sent in place of `body`
  std::uint64_t rest_bytes = 0;                     // how long that is; 0: chunks, written as such, until it ends
};

Response json_response(int status, const nlohmann::json& value);
Response problem_response(const protocol::Problem& problem);
/// A refusal of the connection layer as a problem.
Response refusal_response(const net::Refusal& refusal);

/// The response as it goes over the wire, with the fields every response has and `more`.
std::string wire_format(const Response& response, bool keep_alive, const Fields& more = {});

/// The status of a response in bytes; 0 if it is none.
int status_of(std::string_view response);

/// Fields that every response has, whoever writes it.
Fields common_headers();

}  // namespace lightwell::http
