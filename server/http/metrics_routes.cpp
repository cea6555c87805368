#include "server/services.h"

namespace lightwell {

void add_metrics_routes(http::RouteTable& table, const Services& services) {
  const auto answer = [&services](const http::Request&) {
    return http::Response{200,
                          "text/plain; version=0.0.4; charset=utf-8",
                          services.metrics.exposition(services.levels()),
                          {{"Cache-Control", "no-store"}}};
  };
  table.add({"GET", "/metrics", Scope::kAdmin, http::Effort::kQuick, 0, {}, answer});
}

}  // namespace lightwell
