#include "server/service.h"

#include <algorithm>
#include <condition_variable>
#include <thread>
#include <tuple>

#include "server/http/router.h"
#include "server/operations/log.h"
#include "server/sequences/sequence_workers.h"
#include "server/services.h"

namespace lightwell {
namespace {

using net::Refusal;

constexpr std::size_t kQuickWorkers = 4;
constexpr std::size_t kLongWorkers = 8;  // most of them wait for the render thread
constexpr std::size_t kMostQuickWaiting = 1024;
constexpr std::size_t kMostLongWaiting = 64;
constexpr std::size_t kEncoders = 2;
constexpr auto kHousekeepingInterval = std::chrono::seconds(1);
constexpr glm::ivec2 kWarmUpSize(64, 64);

/// The stream's session id, if `path` is that of a stream.
std::optional<std::string> session_of_stream(std::string_view path) {
  constexpr std::string_view kBefore = "/v1/sessions/", kAfter = "/stream";
  if (!http::matches("/v1/sessions/{id}/stream", path)) return {};
  return std::string(path.substr(kBefore.size(), path.size() - kBefore.size() - kAfter.size()));
}

bool lists_subprotocol(std::string_view list) {
  while (!list.empty()) {
    const auto comma = std::min(list.find(','), list.size());
    std::string_view item = list.substr(0, comma);
    while (item.starts_with(' ')) item.remove_prefix(1);
    while (item.ends_with(' ')) item.remove_suffix(1);
    if (item == protocol::kSubprotocol) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

Refusal busy(std::string detail) {
  return {503, std::move(detail), {{"Retry-After", "1"}}};
}

Refusal refusal_of(const protocol::Problem& problem) {
  return {problem.status, problem.detail, {}};
}

}  // namespace

struct Service::State {
  State(const ServeOptions& serve_options, MakePictureSource make_source, std::function<int()> open_connections);

  void load_scenes();
  Shot warm_up_shot();
  void keep_house();
  Levels levels();
  void count(const net::RequestHead* head, int status, double seconds);
  std::variant<Scopes, Refusal> check_access(const net::RequestHead& below,
                                             const std::optional<std::string>& session_id);
  net::Admission admit_stream(const net::RequestHead& head, const std::string& session_id, Scopes scopes);
  std::optional<Refusal> check_state(std::string_view path) const;
  /// The path without the base path; none if a proxy's user must be sent to the base path's "/".
  std::optional<std::string> path_below_base(const std::string& path) const;

  const ServeOptions options;
  AccessControl access;
  const std::function<int()> connections;
  Metrics metrics;
  SceneStore scenes;
  std::unique_ptr<SequenceStore> sequences;
  SessionStore sessions;
  SessionSurroundings surroundings;
  std::atomic<bool> leaving = false;              // not ready any more
  std::atomic<bool> draining = false;             // and nothing more is begun
  std::promise<std::string> first_scene_promise;  // its name, or SceneRefused
  std::shared_future<std::string> first_scene = first_scene_promise.get_future().share();
  std::atomic<bool> scenes_loaded = false;

  RenderLoop render_loop;
  std::unique_ptr<SequenceWorkers> sequence_workers;
  std::atomic<int> renders_waiting = 0;
  std::unique_ptr<WorkerPool> encoders, quick_workers, long_workers;
  http::RouteTable routes;
  std::unique_ptr<Services> services;
  std::unique_ptr<http::Router> router;

  std::mutex mutex;
  std::condition_variable stopped;
  bool stopping = false;
  std::thread loader, housekeeper;
};

Service::State::State(const ServeOptions& serve_options, MakePictureSource make_source,
                      std::function<int()> open_connections)
    : options(serve_options),
      access(options.access),
      connections(std::move(open_connections)),
      scenes(options.limits),
      sequences(options.data_dir.empty() ? nullptr : std::make_unique<SequenceStore>(options, scenes)),
      sessions(options.limits),
      surroundings{{scenes, options.limits, options.settings},
                   metrics,
                   [this] { render_loop.wake(); },
                   [this] { return render_loop.is_ready() ? render_loop.ready().get().device : std::string(); },
                   [this] {
                     return render_loop.is_ready() ? render_loop.ready().get().methods
                                                   : std::vector<std::string>{"thesis"};
                   }},
      render_loop(
          std::move(make_source), [this] { return warm_up_shot(); },
          [this](Share share, const Result<Frame>& frame, double seconds) {
            if (!frame && frame.error().kind == ErrorKind::kDeviceLost) metrics.device_rebuilt();
            if (!frame) return metrics.frame_failed(frame.error().kind);
            metrics.frame_rendered(*frame, share == Share::kOwn ? Purpose::kStream : Purpose::kRequest, seconds);
          }),
      encoders(std::make_unique<WorkerPool>(kEncoders,
                                            std::size_t{2} * static_cast<std::size_t>(options.limits.max_sessions))),
      quick_workers(std::make_unique<WorkerPool>(kQuickWorkers, kMostQuickWaiting)),
      long_workers(std::make_unique<WorkerPool>(kLongWorkers, kMostLongWaiting)) {
  services =
      std::make_unique<Services>(Services{options, scenes, sessions, render_loop, *encoders, surroundings, leaving,
                                          metrics, sequences.get(), [this] { return levels(); }, renders_waiting});
  if (sequences) sequence_workers = std::make_unique<SequenceWorkers>(*sequences, render_loop);
  add_health_routes(routes, *services);
  add_scene_routes(routes, *services);
  add_session_routes(routes, *services);
  add_render_routes(routes, *services);
  add_sequence_routes(routes, *services);
  add_metrics_routes(routes, *services);
  add_viewer_routes(routes, options.web_client_dir);
  router = std::make_unique<http::Router>(routes,
                                          [this](const net::RequestHead& head) { return access.answer_fields(head); });
  loader = std::thread([this] { load_scenes(); });
  housekeeper = std::thread([this] { keep_house(); });
}

void Service::State::load_scenes() {
  try {
    const Result<std::string> name = scenes.add_from_command_line(options.scene, options.environment);
    if (!name) throw SceneRefused(name.error().message());
    first_scene_promise.set_value(*name);
    scenes.add_builtin_scenes();
    scenes_loaded = true;
  } catch (...) {
    first_scene_promise.set_exception(std::current_exception());
  }
}

/// On the render thread, when the shaders are compiled: waits for the scene. Its geometry is on the device afterwards.
Shot Service::State::warm_up_shot() {
  const std::shared_ptr<const StagedScene> stage = scenes.find(first_scene.get());
  Shot shot;
  shot.scene = stage->scene();
  shot.request.settings = options.settings;
  shot.request.size_px = kWarmUpSize;
  if (auto camera = stage->place(protocol::DefaultCamera(), 0.0, 1.0f)) shot.request.camera = std::move(camera).value();
  return shot;
}

void Service::State::keep_house() {
  std::unique_lock lock(mutex);
  while (!stopped.wait_for(lock, kHousekeepingInterval, [this] { return stopping; })) {
    lock.unlock();
    sessions.keep_house(std::chrono::steady_clock::now());
    if (sequences) sequences->keep_house();
    lock.lock();
  }
}

Levels Service::State::levels() {
  Levels levels;
  std::tie(levels.sessions, levels.viewers) = sessions.size();
  std::tie(levels.uploaded_scenes, levels.uploaded_bytes) = scenes.uploads();
  levels.connections = static_cast<std::uint64_t>(connections());
  levels.renders_waiting = static_cast<std::uint64_t>(renders_waiting.load());
  levels.frames_waiting = sequences ? sequences->frames_waiting() : 0;
  levels.ready = render_loop.is_ready() && scenes_loaded && !leaving;
  return levels;
}

/// `head`: null if it was not understood.
void Service::State::count(const net::RequestHead* head, int status, double seconds) {
  std::string route = "none", method = "none";
  if (head) {
    const auto found = routes.find(*head);
    if (const auto* known = std::get_if<const http::Route*>(&found)) route = (*known)->path;
    if (route != "none") method = head->method;  // any other would be a label of the client's making
  }
  metrics.request_answered(method, route, status, seconds);
  const LogLevel level = status == 500 ? LogLevel::kWarning : LogLevel::kDebug;
  log_event(level, "request",
            {{"method", method},
             {"path", head ? head->path : std::string()},
             {"status", std::int64_t{status}},
             {"ms", seconds * 1e3}});
}

std::optional<std::string> Service::State::path_below_base(const std::string& path) const {
  if (options.base_path.empty() || !path.starts_with(options.base_path)) return path;
  const std::string below = path.substr(options.base_path.size());
  if (below.empty()) return {};
  return below.starts_with('/') ? below : path;
}

std::optional<Refusal> Service::State::check_state(std::string_view path) const {
  const bool about_health = path == "/healthz" || path == "/readyz";
  if (draining && !about_health) return busy("the server is stopping");
  if (!scenes_loaded && path.starts_with("/v1/")) return busy("the scenes are being loaded");
  return {};
}

/// The scopes of the request's token, if they are enough for what it asks. `below` has its path below the base path.
std::variant<Scopes, Refusal> Service::State::check_access(const net::RequestHead& below,
                                                           const std::optional<std::string>& session_id) {
  if (session_id) return access.check_token(below, Scope::kView);
  if (access.is_preflight(below)) return access.check_token(below, Scope::kPublic);
  const auto found = routes.find(below);
  // Nothing is told of what a token would be needed for before there is one, but that it is needed.
  if (const auto* refusal = std::get_if<Refusal>(&found)) {
    const Scope needed = refusal->status == 404 || refusal->status == 405 ? Scope::kPublic : Scope::kView;
    auto scopes = access.check_token(below, needed);
    return std::holds_alternative<Refusal>(scopes) ? scopes : std::variant<Scopes, Refusal>(*refusal);
  }
  return access.check_token(below, std::get<const http::Route*>(found)->scope);
}

net::Admission Service::State::admit_stream(const net::RequestHead& head, const std::string& session_id,
                                            Scopes scopes) {
  if (!head.wants_web_socket)
    return Refusal{426, "a stream is a WebSocket", {{"Upgrade", "websocket"}, {"Connection", "Upgrade"}}};
  const std::string_view subprotocols = head.field("sec-websocket-protocol");
  const bool named = lists_subprotocol(subprotocols);
  if (!subprotocols.empty() && !named) return Refusal{400, "the WebSocket subprotocol spoken here is lightwell.v1", {}};
  const std::shared_ptr<Session> session = sessions.find(session_id);
  if (!session) return Refusal{404, "there is no such session, or it has ended", {}};
  auto viewer = session->open_stream(scopes.has(Scope::kDrive));
  if (!viewer) return refusal_of(viewer.problem());
  return net::WebSocketAdmission{std::move(viewer).value(),
                                 named ? std::string(protocol::kSubprotocol) : std::string()};
}

Service::Service(const ServeOptions& options, MakePictureSource make_source, std::function<int()> connections)
    : state_(std::make_unique<State>(options, std::move(make_source), std::move(connections))) {}

Service::~Service() {
  stop();
}

std::shared_future<SourceFacts> Service::ready() const {
  return state_->render_loop.ready();
}

void Service::announce_drain() {
  state_->leaving = true;
}

void Service::drain() {
  state_->leaving = state_->draining = true;
  state_->sessions.end_all(protocol::CloseCode::kDraining, "the server is stopping", true);
}

void Service::stop() {
  {
    std::lock_guard lock(state_->mutex);
    state_->stopping = true;
  }
  state_->stopped.notify_all();
  if (state_->loader.joinable()) state_->loader.join();
  if (state_->housekeeper.joinable()) state_->housekeeper.join();
  state_->render_loop.stop();  // first: workers wait for it
  state_->sequence_workers.reset();
  state_->long_workers.reset();
  state_->quick_workers.reset();
  state_->encoders.reset();
}

net::Admission Service::admit(const net::RequestHead& head, const net::Peer& peer) {
  const std::optional<std::string> path = state_->path_below_base(head.path);
  if (!path)
    return Refusal{308, "the viewer is at " + head.path + "/", {{"Location", state_->options.base_path + "/"}}};
  const bool about_health = *path == "/healthz" || *path == "/readyz";
  if (!about_health)
    if (auto refusal = state_->access.check_origin_and_rate(head, peer)) return *refusal;
  net::RequestHead below = head;
  below.path = *path;
  const auto session_id = head.method == "GET" ? session_of_stream(*path) : std::nullopt;
  const auto scopes = state_->check_access(below, session_id);
  if (const auto* refusal = std::get_if<Refusal>(&scopes)) return *refusal;
  if (state_->access.is_preflight(head)) return net::HttpAdmission{};
  if (auto refusal = state_->check_state(*path)) return *refusal;
  if (session_id) return state_->admit_stream(head, *session_id, std::get<Scopes>(scopes));
  return net::HttpAdmission{std::get<const http::Route*>(state_->routes.find(below))->max_body_bytes};
}

void Service::answer(net::Request request, std::function<void(net::Answer)> done) {
  request.head.path = state_->path_below_base(request.head.path).value_or("/");
  const auto refuse = [&](const Refusal& refusal) {
    done({refusal_response(refusal, request.keep_alive, &request.head), nullptr});
  };
  if (state_->access.is_preflight(request.head)) {
    http::Fields fields = state_->access.answer_fields(request.head);
    for (auto& field : AccessControl::preflight_fields()) fields.push_back(std::move(field));
    return done({http::wire_format({204, {}, {}, {}}, request.keep_alive, fields), nullptr});
  }
  const auto found = state_->routes.find(request.head);
  if (const auto* refusal = std::get_if<Refusal>(&found)) return refuse(*refusal);
  const bool quick = std::get<const http::Route*>(found)->effort == http::Effort::kQuick;
  WorkerPool& workers = quick ? *state_->quick_workers : *state_->long_workers;
  auto shared = std::make_shared<net::Request>(std::move(request));
  state_->metrics.bytes_received(shared->body.size());
  const auto start = std::chrono::steady_clock::now();
  const bool taken = workers.try_post([state = state_.get(), shared, done, start] {
    net::Answer answer = state->router->respond(*shared);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    state->count(&shared->head, http::status_of(answer.bytes), took.count());
    done(std::move(answer));
  });
  if (taken) return;
  request = std::move(*shared);
  refuse(busy("too many requests wait already"));
}

std::string Service::refusal_response(const Refusal& refusal, bool keep_alive, const net::RequestHead* head) {
  state_->count(head, refusal.status, 0.0);
  return http::wire_format(http::refusal_response(refusal), keep_alive,
                           head ? state_->access.answer_fields(*head) : http::Fields());
}

}  // namespace lightwell
