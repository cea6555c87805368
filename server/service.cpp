#include "server/service.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "server/operations/background_task.h"
#include "server/operations/log.h"
#include "server/render/metered_source.h"
#include "server/service_state.h"
#include "server/video/video_encoder.h"

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

/// What sessions begin with is never more than what they may ask for.
ServeOptions with_settings_within_limits(ServeOptions options) {
  options.settings.samples = std::min(options.settings.samples, options.limits.max_samples);
  return options;
}

}  // namespace

Service::State::State(const ServeOptions& serve_options, MakePictureSource make_source, FrameEncoders encode_frames,
                      std::function<int()> open_connections)
    : options(with_settings_within_limits(serve_options)),
      access(options.access),
      encode(std::move(encode_frames)),
      connections(std::move(open_connections)),
      scenes(options.limits),
      scene_files(options.data_dir.empty() ? nullptr
                                           : std::make_unique<SceneFiles>(options.data_dir, scenes, options.limits)),
      sequences(scene_files ? std::make_unique<SequenceStore>(options, scenes, *scene_files) : nullptr),
      session_keeper(scene_files ? std::make_unique<SessionKeeper>(options.data_dir, *scene_files, metrics) : nullptr),
      sessions(options.limits, session_keeper.get()),
      surroundings{{scenes, options.limits, options.settings},
                   metrics,
                   [this] { render_loop.wake(); },
                   [this] { return render_loop.is_ready() ? render_loop.ready().get().device : std::string(); },
                   [this] {
                     return render_loop.is_ready()
                                ? render_loop.ready().get().methods
                                : std::vector<std::string>{std::string(name_of(options.settings.method))};
                   },
                   [this] { return codecs(); },
                   [this](std::shared_ptr<DirectedSession> session, std::shared_ptr<RenderAccount> account) {
                     direct(std::move(session), std::move(account));
                   },
                   [this](std::shared_ptr<const Session> session) {
                     if (session_keeper) session_keeper->changed(std::move(session));
                   }},
      render_loop(
          with_memory_meter(std::move(make_source), metrics), [this] { return warm_up_shot(); },
          [this](Share share, const Result<Frame>& frame, double seconds) {
            if (!frame && frame.error().kind == ErrorKind::kDeviceLost) metrics.device_rebuilt();
            if (!frame) return metrics.frame_failed(frame.error().kind);
            metrics.frame_rendered(*frame, share == Share::kOwn ? Purpose::kStream : Purpose::kRequest, seconds);
          }),
      encoders(std::make_unique<WorkerPool>(kEncoders,
                                            std::size_t{2} * static_cast<std::size_t>(options.limits.max_sessions))),
      quick_workers(std::make_unique<WorkerPool>(kQuickWorkers, kMostQuickWaiting)),
      long_workers(std::make_unique<WorkerPool>(kLongWorkers, kMostLongWaiting)) {
  services = std::make_unique<Services>(Services{options, scenes, sessions, render_loop, *encoders, surroundings,
                                                 leaving, metrics, sequences.get(), [this] { return levels(); },
                                                 renders_waiting, *long_workers, films});
  if (sequences) scene_files->add_user([this](const std::string& digest) { return sequences->uses_scene(digest); });
  if (sequences) sequence_workers = std::make_unique<SequenceWorkers>(*sequences, render_loop, metrics);
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
    codecs();  // loads the encoder before somebody waits for it
  } catch (...) {
    first_scene_promise.set_exception(std::current_exception());
  }
}

std::vector<std::string> Service::State::codecs() const {
  std::vector<std::string> codecs{"jpeg"};
  if (options.video && can_encode_video()) codecs.emplace_back("h264");
  return codecs;
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

void Service::State::direct(std::shared_ptr<DirectedSession> session, std::shared_ptr<RenderAccount> account) {
  DirectorOptions director;
  director.quality = options.quality;
  director.encode = encode;
  director.still_before_reference = std::chrono::milliseconds(std::llround(options.reference_after_s * 1000.0));
  render_loop.add(std::make_shared<Director>(std::move(session), *encoders, director), Share::kOwn, std::move(account));
}

void Service::State::keep_house() {
  BackgroundTask streams("sessions", metrics), kept("kept_sessions", metrics), jobs("sequences", metrics);
  std::unique_lock lock(mutex);
  while (!stopped.wait_for(lock, kHousekeepingInterval, [this] { return stopping; })) {
    lock.unlock();
    streams.attempt([this] { sessions.keep_house(std::chrono::steady_clock::now()); });
    kept.attempt([this] { sessions.end_lost(); });
    if (sequences) jobs.attempt([this] { sequences->keep_house(); });
    lock.lock();
  }
}

Levels Service::State::levels() {
  Levels levels;
  std::tie(levels.sessions, levels.viewers) = sessions.size();
  std::tie(levels.uploaded_scenes, levels.uploaded_bytes) = scenes.uploads();
  levels.connections = static_cast<std::uint64_t>(connections());
  levels.renders_waiting = static_cast<std::uint64_t>(renders_waiting.load());
  try {
    levels.frames_waiting = sequences ? sequences->frames_waiting() : 0;
  } catch (const DatabaseError&) {  // all other numbers are still worth telling
    levels.frames_waiting.reset();
  }
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

Service::Service(const ServeOptions& options, MakePictureSource make_source, std::function<int()> connections,
                 FrameEncoders encode)
    : state_(std::make_unique<State>(options, std::move(make_source), std::move(encode), std::move(connections))) {}

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
