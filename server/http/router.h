// Requests to the handlers of their routes, by cpp-httplib. It never sees a socket, nor a byte that the connection
// layer has not checked: it is given a head written anew from what was understood, and the body beside it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/http/route_table.h"
#include "server/net/application.h"

namespace lightwell::http {

/// Thread-safe once made. Needs a request for which `RouteTable::find` gave a route.
class Router {
 public:
  /// Fields that the answers to a request have besides those of every answer.
  using MoreFields = std::function<Fields(const net::RequestHead&)>;

  /// `table` outlives the router.
  Router(const RouteTable& table, MoreFields more_fields);
  ~Router();

  /// Long work is done on the calling thread. An exception of a handler is a 500 that tells nothing of it.
  net::Answer respond(const net::Request& request);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightwell::http
