// Which requests there are: method and path, what body they may bring, and who answers them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/access/scope.h"
#include "server/http/message.h"

namespace lightwell::http {

using Handler = std::function<Response(const Request&)>;

/// Who answers: quick work must not wait behind long work.
enum class Effort { kQuick, kLong };

struct Route {
  std::string method;
  std::string path;             // "/v1/scenes/{name}": a name in braces stands for one segment
  Scope scope = Scope::kAdmin;  // what a client's token must allow
  Effort effort = Effort::kQuick;
  std::uint64_t max_body_bytes = 0;
  std::vector<std::string> content_types;  // that a body may have; empty: no body is taken
  Handler handler;
  bool is_page = false;  // of the viewer: nothing is posted to it
};

class RouteTable {
 public:
  void add(Route route) { routes_.push_back(std::move(route)); }
  const std::vector<Route>& routes() const { return routes_; }

  /// The route for a request, or why there is none: 404, 405 with Allow, 411, 413 or 415. HEAD is served as GET. Who
  /// posts to a page has mistaken the address of what would take it: 404, as servers of files answer.
  std::variant<const Route*, net::Refusal> find(const net::RequestHead& head) const;

 private:
  std::vector<Route> routes_;
};

/// Whether a path is one that the template stands for.
bool matches(std::string_view path_template, std::string_view path);

}  // namespace lightwell::http
