#include "protocol/names.h"
#include "server/convert.h"
#include "server/http/picture_file.h"
#include "server/render/render_job.h"
#include "server/services.h"

namespace lightwell {
namespace {

using http::Request;
using http::Response;
using protocol::Decoded;
using protocol::ImageFormat;

constexpr std::uint64_t kMaxJsonBytes = 1u << 20;
constexpr int kClientClosedRequest = 499;  // never sent, for nobody is there; what logs and metrics call it since nginx

/// A picture to make once, as a request described it.
struct Order {
  Shot shot;
  ImageFormat format = ImageFormat::kPng;
  std::uint32_t frames = 1;
};

Order make_order(const StagedScene& stage, PlacedCamera camera, double time_s, glm::ivec2 size_px, Settings settings,
                 ImageFormat format) {
  Order order;
  order.format = format;
  order.shot.scene = stage.scene();
  order.shot.request.time_s = time_s;
  order.shot.request.camera = std::move(camera);
  order.shot.request.size_px = size_px;
  order.shot.request.settings = settings;
  order.shot.request.settings.target_fps = 0;  // the same request gives the same bytes
  order.shot.request.want_linear = format == ImageFormat::kExr;
  order.shot.request.want_display = format != ImageFormat::kExr;
  return order;
}

/// The scene of a render request with its edits.
Decoded<std::shared_ptr<const StagedScene>> edited_scene(const protocol::RenderRequest& request,
                                                         const Services& services) {
  std::shared_ptr<const StagedScene> stage = services.scenes.find(request.scene);
  if (!stage) return no_such_scene(request.scene, 422, "/scene");
  if (request.edits.empty()) return stage;
  Decoded<Scene> scene = edited(*stage->scene(), request.edits, services.options.limits);
  if (!scene) return scene.problem();
  return std::shared_ptr<const StagedScene>(std::make_shared<StagedScene>(std::move(scene).value()));
}

Decoded<Order> order_of(const protocol::RenderRequest& request, const Services& services) {
  const ServeLimits& limits = services.options.limits;
  const glm::ivec2 size_px(request.width, request.height);
  if (auto problem = check_size(size_px, limits, "")) return *problem;
  if (request.spp_frames > static_cast<std::uint32_t>(limits.max_spp_frames))
    return protocol::make_problem(
        422, "a picture may have at most " + std::to_string(limits.max_spp_frames) + " frames", "/spp_frames");
  const auto settings = with_spec(services.options.settings, request.settings, size_px, limits, "/settings");
  if (!settings) return settings.problem();
  const auto stage = edited_scene(request, services);
  if (!stage) return stage.problem();
  const float aspect_ratio = static_cast<float>(size_px.x) / static_cast<float>(size_px.y);
  auto camera = (*stage)->place(request.camera, request.time_s, aspect_ratio);
  if (!camera) return camera.problem();
  Order order = make_order(**stage, std::move(camera).value(), request.time_s, size_px, *settings, request.format);
  order.frames = request.spp_frames;
  return order;
}

/// A session as it is now, in another size or view if the query says so.
Decoded<Order> order_of(const SessionState& state, const protocol::FrameQuery& query, const Services& services) {
  glm::ivec2 size_px = state.size_px;
  if (query.width) size_px.x = *query.width;
  if (query.height) size_px.y = *query.height;
  if (auto problem = check_size(size_px, services.options.limits, "")) return *problem;
  protocol::SettingsSpec view;
  view.view = query.view;
  const auto settings = with_spec(state.settings, view, size_px, services.options.limits, "");
  if (!settings) return settings.problem();
  const double time_s = state.clock.time_s(std::chrono::steady_clock::now());
  auto camera = state.stage->place(state.camera, time_s, static_cast<float>(size_px.x) / static_cast<float>(size_px.y));
  if (!camera) return camera.problem();
  return make_order(*state.stage, std::move(camera).value(), time_s, size_px, *settings, query.format);
}

/// Waits for the render thread; the calling thread encodes.
Response carry_out(Order order, const Services& services, const Request& request) {
  if (!services.render_loop.is_ready())
    return http::problem_response(protocol::make_problem(503, "the shaders are being compiled"));
  const ImageFormat format = order.format;
  auto job = std::make_shared<RenderJob>(std::move(order.shot), order.frames, request.gone);
  std::future<Result<Frame>> result = job->result();
  ++services.renders_waiting;
  services.render_loop.add(std::move(job), Share::kJobs);
  const Result<Frame> frame = result.get();
  --services.renders_waiting;
  if (!frame && *request.gone)
    return http::problem_response(protocol::make_problem(kClientClosedRequest, frame.error().what));
  if (!frame) return http::problem_response(problem_of(frame.error()));
  return http::picture_response(*frame, format);
}

Response post_render(const Services& services, const Request& request) {
  const auto wanted = protocol::parse_render_request(request.body);
  if (!wanted) return http::problem_response(wanted.problem());
  auto order = order_of(*wanted, services);
  if (!order) return http::problem_response(order.problem());
  return carry_out(std::move(order).value(), services, request);
}

Response get_frame(const Services& services, const Request& request) {
  const auto session = services.sessions.find_or_take_up(request.path_parameters[0], services.surroundings);
  if (!session) return http::problem_response(session.problem());
  const auto query = protocol::parse_frame_query(request.query);
  if (!query) return http::problem_response(query.problem());
  auto order = order_of(*(*session)->state(), *query, services);
  if (!order) return http::problem_response(order.problem());
  return carry_out(std::move(order).value(), services, request);
}

}  // namespace

void add_render_routes(http::RouteTable& table, const Services& services) {
  using enum http::Effort;
  table.add(
      {"POST", "/v1/render", Scope::kDrive, kLong, kMaxJsonBytes, {"application/json"}, [&](const Request& request) {
         return post_render(services, request);
       }});
  table.add({"GET", "/v1/sessions/{id}/frame", Scope::kView, kLong, 0, {}, [&](const Request& request) {
               return get_frame(services, request);
             }});
}

}  // namespace lightwell
