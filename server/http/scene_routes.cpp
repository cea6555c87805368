#include "protocol/names.h"
#include "renderer/scene/gltf/edit.h"
#include "server/operations/log.h"
#include "server/services.h"

namespace lightwell {
namespace {

using http::Request;
using http::Response;

Response list_scenes(const Services& services) {
  return http::json_response(200, protocol::to_json(services.scenes.entries()));
}

Response get_scene(const Services& services, const std::string& name) {
  const std::shared_ptr<const StagedScene> scene = services.scenes.find(name);
  if (!scene) return http::problem_response(no_such_scene(name, 404));
  return http::json_response(200, describe_scene(*scene->scene()));
}

Response put_scene(const Services& services, const std::string& name, std::string_view body) {
  if (!protocol::is_scene_name(name))
    return http::problem_response(
        protocol::make_problem(422, "a scene's name is 1 to 64 of a to z, 0 to 9, _ and -, not \"" + name + "\""));
  const auto stored = services.scenes.upload(name, std::as_bytes(std::span(body.data(), body.size())));
  if (!stored) return http::problem_response(stored.problem());
  log_event(LogLevel::kInfo, "scene_uploaded", {{"scene", name}, {"bytes", static_cast<std::int64_t>(body.size())}});
  services.sessions.scenes_changed();
  Response response = http::json_response(stored->created ? 201 : 200, protocol::to_json(stored->entry));
  if (stored->created) response.headers.emplace_back("Location", services.options.base_path + "/v1/scenes/" + name);
  return response;
}

Response delete_scene(const Services& services, const std::string& name) {
  if (const auto problem = services.scenes.remove(name)) return http::problem_response(*problem);
  services.sessions.scenes_changed();
  return {204, {}, {}, {}};
}

}  // namespace

void add_scene_routes(http::RouteTable& table, const Services& services) {
  using enum http::Effort;
  table.add({"GET", "/v1/scenes", Scope::kView, kQuick, 0, {}, [&](const Request&) { return list_scenes(services); }});
  table.add({"GET", "/v1/scenes/{name}", Scope::kView, kQuick, 0, {}, [&](const Request& request) {
               return get_scene(services, request.path_parameters[0]);
             }});
  table.add({"PUT",
             "/v1/scenes/{name}",
             Scope::kUpload,
             kLong,
             services.options.limits.max_upload_bytes,
             {"model/gltf-binary", "application/octet-stream"},
             [&](const Request& request) { return put_scene(services, request.path_parameters[0], request.body); }});
  table.add({"DELETE", "/v1/scenes/{name}", Scope::kUpload, kQuick, 0, {}, [&](const Request& request) {
               return delete_scene(services, request.path_parameters[0]);
             }});
}

}  // namespace lightwell
