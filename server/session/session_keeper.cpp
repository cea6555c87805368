#include "server/session/session_keeper.h"

#include "server/operations/log.h"

namespace lightwell {
namespace {

using protocol::make_problem;

constexpr auto kBetweenWrites = std::chrono::milliseconds(100);

std::int64_t unix_milliseconds() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

}  // namespace

SessionKeeper::SessionKeeper(const std::string& data_dir, SceneFiles& scenes, Metrics& metrics)
    : scenes_(scenes), metrics_(metrics), archive_(std::filesystem::path(data_dir) / "sessions.sqlite") {
  scenes_.add_user([this](const std::string& digest) { return archive_.uses_scene(digest); });
  writer_ = std::thread([this] { run(); });
}

SessionKeeper::~SessionKeeper() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  woken_.notify_all();
  writer_.join();
}

void SessionKeeper::run() {
  std::unique_lock lock(mutex_);
  for (bool last = false; !last;) {
    woken_.wait(lock, [this] { return stopping_ || !changed_.empty(); });
    last = stopping_;
    const auto changed = std::exchange(changed_, {});
    lock.unlock();
    for (const auto& [id, session] : changed)
      if (!session->ended()) keep(*session);
    lock.lock();
    woken_.wait_for(lock, kBetweenWrites, [this] { return stopping_; });
  }
}

void SessionKeeper::write(const Session& session, bool and_release) {
  const std::string& id = session.id();
  const std::shared_ptr<const SessionState> state = session.state();
  std::lock_guard lock(writing_mutex_);
  if (session.ended()) return;  // and is forgotten, or will be
  try {
    if (!state->edits) {
      if (written_.contains(id)) say_not_kept(id, "it has more edits than are kept");
      return drop(id);
    }
    const Status scene_kept = scenes_.keep(state->source);
    KeptSession form = session.kept_form();
    form.unix_ms = unix_milliseconds();
    if (and_release) {
      archive_.release(id, form);
      written_.erase(id);
    } else {
      archive_.write(id, form);
      written_.insert(id);
    }
    if (!scene_kept) return failed(id, scene_kept.error().message());
    failing_.erase(id);
  } catch (const std::exception& error) {
    failed(id, error.what());
  }
}

/// With the lock on writing held. Said once: a session changes up to ten times a second.
void SessionKeeper::failed(const std::string& id, const std::string& reason) {
  metrics_.background_task_failed("session_writing");
  if (failing_.insert(id).second) say_not_kept(id, reason);
}

void SessionKeeper::say_not_kept(const std::string& id, const std::string& reason) {
  log_event(LogLevel::kWarning, "session_not_kept", {{"session", id}, {"reason", reason}});
}

void SessionKeeper::keep(const Session& session) {
  write(session, false);
}

void SessionKeeper::release(const Session& session) {
  write(session, true);
}

/// With the lock on writing held.
void SessionKeeper::drop(const std::string& id) {
  written_.erase(id);
  failing_.erase(id);
  archive_.remove(id);
}

void SessionKeeper::changed(std::shared_ptr<const Session> session) {
  {
    std::lock_guard lock(mutex_);
    changed_[session->id()] = session;
  }
  woken_.notify_all();
}

void SessionKeeper::forget(const std::string& id) {
  std::lock_guard lock(writing_mutex_);
  try {
    drop(id);
  } catch (const std::exception& error) {  // nobody will take it up: it is not seen any more
    log_event(LogLevel::kWarning, "session_not_forgotten", {{"session", id}, {"reason", std::string(error.what())}});
  }
}

protocol::Decoded<SessionKeeper::TakenUp> SessionKeeper::take_up(const std::string& id, const SessionRules& rules) {
  const auto claimed = archive_.claim(id);
  if (std::holds_alternative<SessionArchive::Elsewhere>(claimed))
    return make_problem(503, "the session is at another server, or was until a moment ago");
  const auto* kept = std::get_if<KeptSession>(&claimed);
  if (!kept) return no_such_session();
  protocol::SessionRequest request = kept->request;
  request.time_s = kept->time_s(unix_milliseconds());
  auto source = scenes_.find(request.scene, kept->scene_digest);
  auto state = source ? make_session_state(request, std::move(source).value(), kept->edits, rules,
                                           std::chrono::steady_clock::now())
                      : protocol::Decoded<SessionState>(source.problem());
  if (!state) {
    log_event(LogLevel::kWarning, "session_not_taken_up", {{"session", id}, {"reason", state.problem().detail}});
    archive_.release(id, *kept);
    return no_such_session();
  }
  state->revision = kept->revision + 1;
  {
    std::lock_guard lock(writing_mutex_);
    written_.insert(id);
  }
  return TakenUp{std::move(state).value(), kept->request.idle_s.value_or(rules.limits.session_idle_s), kept->driver};
}

std::set<std::string> SessionKeeper::keep_house() {
  std::set<std::string> lost;
  {
    std::lock_guard lock(writing_mutex_);
    lost = written_;
  }
  const SessionArchive::Beat beat = archive_.beat();
  for (const std::string& digest : beat.scenes_let_go) scenes_.remove_if_unused(digest);
  std::erase_if(lost, [&](const std::string& id) { return beat.own.contains(id); });
  return lost;
}

}  // namespace lightwell
