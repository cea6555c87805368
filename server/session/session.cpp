#include "server/session/session.h"

#include <algorithm>

#include "server/convert.h"

namespace lightwell {

using protocol::make_problem;
using protocol::Problem;
using std::chrono::steady_clock;

namespace {

constexpr auto kSeatReserved = std::chrono::seconds(15);  // a viewer waits for 10 s at most before it tries again

/// The first of those that the client takes which this server has.
std::string codec_for(const protocol::Hello& hello, const std::vector<std::string>& codecs) {
  const auto chosen = std::find_first_of(hello.codecs.begin(), hello.codecs.end(), codecs.begin(), codecs.end());
  return chosen != hello.codecs.end() ? *chosen : "jpeg";
}

}  // namespace

Problem no_such_session() {
  return make_problem(404, "there is no such session, or it has ended");
}

Session::Session(std::string id, SessionState state, const SessionSurroundings& surroundings, double idle_s)
    : id_(std::move(id)),
      surroundings_(surroundings),
      idle_s_(idle_s),
      state_(std::make_shared<const SessionState>(std::move(state))),
      touched_(steady_clock::now()) {}

protocol::Session Session::describe() const {
  const std::shared_ptr<const SessionState> state = this->state();
  protocol::Session session;
  session.id = id_;
  session.scene = state->scene_name;
  session.width = static_cast<std::uint16_t>(state->size_px.x);
  session.height = static_cast<std::uint16_t>(state->size_px.y);
  session.camera = state->camera;
  session.settings = spec_of(state->settings);
  session.playing = state->clock.playing();
  session.time_s = state->clock.time_s(steady_clock::now());
  session.revision = state->revision;
  session.viewers = static_cast<std::uint32_t>(audience_.size());
  session.idle_s = idle_s_;
  return session;
}

KeptSession Session::kept_form() const {
  const std::shared_ptr<const SessionState> state = this->state();
  KeptSession kept;
  kept.request.scene = state->scene_name;
  kept.request.camera = state->camera;
  kept.request.settings = spec_of(state->settings);
  kept.request.width = static_cast<std::uint16_t>(state->size_px.x);
  kept.request.height = static_cast<std::uint16_t>(state->size_px.y);
  kept.request.playing = state->clock.playing();
  kept.request.time_s = state->clock.time_s(steady_clock::now());
  kept.request.idle_s = idle_s_;
  if (state->edits) kept.edits = *state->edits;
  kept.scene_digest = state->source.scene->digest();
  kept.revision = state->revision;
  std::lock_guard lock(driver_mutex_);
  kept.driver = driver_ ? driver_->resume_token() : reserved_for_;
  return kept;
}

void Session::reserve_seat(const std::string& resume_token) {
  std::lock_guard lock(driver_mutex_);
  reserved_for_ = resume_token;
  reserved_until_ = steady_clock::now() + kSeatReserved;
}

std::optional<Problem> Session::apply_input(const protocol::Input& input, Viewer& by) {
  return change(input.change, &by, input.seq);
}

std::optional<Problem> Session::change(const protocol::SessionPatch& patch, Viewer* by, std::uint32_t seq) {
  std::lock_guard one_at_a_time(change_mutex_);
  if (ended_) return no_such_session();
  protocol::Decoded<SessionState> next = changed(*state(), patch, surroundings_.rules, steady_clock::now());
  if (!next) return next.problem();
  if (by) by->input_applied(next->revision, seq);
  {
    std::lock_guard lock(state_mutex_);
    state_ = std::make_shared<const SessionState>(std::move(next).value());
  }
  tell_changed();
  if (patch.scene) end_looks();  // another scene is another place
  audience_.tell_change(members_of(patch), by, seq);
  surroundings_.wake_render_loop();
  return {};
}

/// The look that a viewer has, or a new one if there may be another.
protocol::Decoded<std::shared_ptr<OwnLook>> Session::own_look_of(Viewer& viewer) {
  std::lock_guard lock(looks_mutex_);
  if (const auto found = looks_.find(&viewer); found != looks_.end()) return found->second;
  const auto most = static_cast<std::size_t>(surroundings_.rules.limits.max_own_looks);
  if (looks_.size() >= most)
    return make_problem(503, std::to_string(most) + " viewers look at this session for themselves, as many as may");
  auto look = std::make_shared<OwnLook>(shared_from_this(), viewer.shared_from_this());
  looks_.emplace(&viewer, look);
  return look;
}

/// False if there was none.
bool Session::end_look(Viewer& viewer) {
  std::shared_ptr<OwnLook> ended;
  {
    std::lock_guard lock(looks_mutex_);
    const auto found = looks_.find(&viewer);
    if (found == looks_.end()) return false;
    ended = std::move(found->second);
    looks_.erase(found);
  }
  ended->end();
  viewer.watch(audience_.source(), false);
  return true;
}

void Session::end_looks() {
  std::vector<std::shared_ptr<Viewer>> viewers;
  {
    std::lock_guard lock(looks_mutex_);
    for (const auto& [viewer, look] : looks_) viewers.push_back(viewer->shared_from_this());
  }
  for (const auto& viewer : viewers) end_look(*viewer);
}

std::optional<Problem> Session::apply_look(const protocol::Look& look, Viewer& by) {
  const std::shared_ptr<const SessionState> state = this->state();
  if (look.shares_pictures()) {
    end_look(by);
    by.input_applied(state->revision, look.seq);
    if (!state->moving()) audience_.show_latest(by, state->revision);
    surroundings_.wake_render_loop();
    return {};
  }
  const SessionState wanted = looked_at(*state, look);
  if (auto problem = check_size(wanted.size_px, surroundings_.rules.limits, "")) return problem;
  if (auto camera = wanted.stage->place(wanted.camera, 0.0, wanted.aspect_ratio()); !camera) return camera.problem();
  const auto own = own_look_of(by);
  if (!own) return own.problem();
  const bool is_new = by.source() != (*own)->audience().source();
  by.input_applied((*own)->change(look), look.seq);
  by.watch((*own)->audience().source(), look.camera.has_value());
  if (is_new) surroundings_.direct(*own, account_);
  surroundings_.wake_render_loop();
  return {};
}

void Session::end(protocol::CloseCode code, const std::string& reason, bool reconnect) {
  ended_ = true;
  audience_.end(code, reason, reconnect);
  surroundings_.wake_render_loop();
}

void Session::scenes_changed() {
  audience_.tell_change(kChangedScenes, nullptr, 0);
}

protocol::StateUpdate Session::change_of(unsigned members) const {
  const std::shared_ptr<const SessionState> state = this->state();
  protocol::StateUpdate update = state_update(*state, members, state->clock.time_s(steady_clock::now()));
  if (members & kChangedScenes) update.scenes = surroundings_.rules.scenes.entries();
  return update;
}

void Session::touch() {
  std::lock_guard lock(state_mutex_);
  touched_ = steady_clock::now();
}

SteadyTime Session::idle_since() const {
  if (audience_.size() > 0) return SteadyTime::max();
  std::lock_guard lock(state_mutex_);
  return touched_;
}

protocol::Decoded<std::shared_ptr<Viewer>> Session::open_stream(bool may_drive) {
  auto viewer = std::make_shared<Viewer>(shared_from_this(), may_drive);
  viewer->watch(audience_.source(), false);
  const auto most = static_cast<std::size_t>(surroundings_.rules.limits.max_viewers_per_session);
  if (!audience_.join(viewer, most))
    return make_problem(503, "the session has " + std::to_string(most) + " viewers, as many as it may have");
  if (ended_) viewer->end(protocol::CloseCode::kSessionEnded, "the session was ended", true);
  return viewer;
}

protocol::Decoded<protocol::Welcome> Session::greet(const protocol::Hello& hello, Viewer& viewer) {
  if (std::find(hello.codecs.begin(), hello.codecs.end(), "jpeg") == hello.codecs.end())
    return make_problem(422, "every client takes jpeg, whatever else it takes", "/codecs");
  if (hello.resume) resume(*hello.resume);
  const protocol::Role role = seat(hello, viewer);
  if (role == protocol::Role::kDriver) {
    protocol::SessionPatch size;  // the picture fits the driver's window
    const int most = surroundings_.rules.limits.max_size_px;
    size.width = static_cast<std::uint16_t>(std::min<int>(hello.width, most));
    size.height = static_cast<std::uint16_t>(std::min<int>(hello.height, most));
    const glm::ivec2 now = state()->size_px;
    const bool same = now.x == *size.width && now.y == *size.height;
    if (auto problem = same ? std::nullopt : change(size, nullptr, 0)) return *problem;
  }
  const std::shared_ptr<const SessionState> state = this->state();
  if (!state->moving()) audience_.show_latest(viewer, state->revision);
  protocol::Welcome answer = welcome(*state);
  answer.role = role;
  answer.codec = codec_for(hello, answer.codecs);
  return answer;
}

/// The role that a viewer gets: one of a session's viewers drives, the first that asks and may.
protocol::Role Session::seat(const protocol::Hello& hello, const Viewer& viewer) {
  {
    std::lock_guard lock(driver_mutex_);
    const bool is_reserved = !reserved_for_.empty() && hello.resume != reserved_for_;
    const bool is_taken = driver_ || (is_reserved && steady_clock::now() < reserved_until_);
    if (hello.role != protocol::Role::kDriver || !viewer.may_drive() || is_taken) return protocol::Role::kViewer;
    driver_ = &viewer;
    reserved_for_.clear();
  }
  tell_changed();
  return protocol::Role::kDriver;
}

/// Who has the token of an earlier stream takes its place, and its role if it wants that.
void Session::resume(const std::string& token) {
  {
    std::lock_guard lock(driver_mutex_);
    if (driver_ && driver_->resume_token() == token) driver_ = nullptr;
  }
  audience_.end_resumed(token);
}

protocol::Welcome Session::welcome(const SessionState& state) const {
  const ServeLimits& limits = surroundings_.rules.limits;
  protocol::Welcome welcome;
  welcome.session = id_;
  welcome.scene = state.scene_name;
  welcome.scenes = surroundings_.rules.scenes.entries();
  welcome.settings = spec_of(state.settings);
  welcome.camera = state.camera;
  welcome.playing = state.clock.playing();
  welcome.time_s = state.clock.time_s(steady_clock::now());
  welcome.device = surroundings_.device();
  welcome.limits.max_width = welcome.limits.max_height = static_cast<std::uint32_t>(limits.max_size_px);
  welcome.limits.max_samples = static_cast<std::uint32_t>(limits.max_samples);
  welcome.limits.max_upload_bytes = limits.max_upload_bytes;
  welcome.methods = surroundings_.methods();
  welcome.codecs = surroundings_.codecs();
  welcome.bounds = state.stage->bounds();
  welcome.view = view_at(state, welcome.time_s);
  welcome.lights = state.stage->lights(welcome.time_s);
  return welcome;
}

std::shared_ptr<const SessionState> Session::state() const {
  std::lock_guard lock(state_mutex_);
  return state_;
}

void Session::leave(Viewer& viewer) {
  end_look(viewer);
  {
    std::lock_guard lock(driver_mutex_);
    if (driver_ == &viewer) driver_ = nullptr;
  }
  tell_changed();
  audience_.leave(viewer);
  touch();
}

}  // namespace lightwell
