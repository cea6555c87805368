#include "protocol/openapi_document.h"
#include "server/services.h"

namespace lightwell {

void add_health_routes(http::RouteTable& table, const Services& services) {
  table.add({"GET", "/healthz", Scope::kPublic, http::Effort::kQuick, 0, {}, [](const http::Request&) {
               return http::json_response(200, {{"status", "ok"}});
             }});
  table.add({"GET", "/readyz", Scope::kPublic, http::Effort::kQuick, 0, {}, [&services](const http::Request&) {
               if (services.leaving)
                 return http::problem_response(protocol::make_problem(503, "the server is stopping"));
               if (!services.render_loop.is_ready())
                 return http::problem_response(protocol::make_problem(503, "the shaders are being compiled"));
               if (!services.levels().ready)
                 return http::problem_response(protocol::make_problem(503, "the scenes are being loaded"));
               return http::json_response(200, {{"status", "ready"}});
             }});
  table.add({"GET", "/v1/openapi.json", Scope::kPublic, http::Effort::kQuick, 0, {}, [](const http::Request&) {
               return http::Response{200, "application/json", std::string(protocol::openapi_document()), {}};
             }});
}

}  // namespace lightwell
