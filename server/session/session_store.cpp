#include "server/session/session_store.h"

#include "server/operations/log.h"
#include "server/random_id.h"
#include "server/session/session_keeper.h"

namespace lightwell {

protocol::Problem SessionStore::too_many() const {
  return protocol::make_problem(
      503, "there are " + std::to_string(limits_.max_sessions) + " sessions already, as many as this server serves");
}

/// False if there are as many as may be.
bool SessionStore::insert(std::shared_ptr<Session> session) {
  std::lock_guard lock(mutex_);
  if (sessions_.size() >= static_cast<std::size_t>(limits_.max_sessions)) return false;
  const std::string id = session->id();
  sessions_.emplace(id, std::move(session));
  return true;
}

protocol::Decoded<std::shared_ptr<Session>> SessionStore::add(SessionState state,
                                                              const SessionSurroundings& surroundings, double idle_s) {
  auto session = std::make_shared<Session>(random_id(), std::move(state), surroundings, idle_s);
  if (!insert(session)) return too_many();
  log_event(LogLevel::kInfo, "session_begun", {{"session", session->id()}});
  keep(*session);
  return session;
}

void SessionStore::keep(const Session& session) const {
  if (keeper_) keeper_->keep(session);
}

std::shared_ptr<Session> SessionStore::find(const std::string& id) {
  std::lock_guard lock(mutex_);
  const auto found = sessions_.find(id);
  if (found == sessions_.end()) return nullptr;
  found->second->touch();
  return found->second;
}

protocol::Decoded<std::shared_ptr<Session>> SessionStore::find_or_take_up(const std::string& id,
                                                                          const SessionSurroundings& surroundings) {
  if (auto session = find(id)) return session;
  if (!keeper_) return no_such_session();
  std::lock_guard one_at_a_time(take_up_mutex_);
  if (auto session = find(id)) return session;
  if (size().first >= static_cast<std::size_t>(limits_.max_sessions)) return too_many();  // it stays another's
  auto taken = keeper_->take_up(id, surroundings.rules);
  if (!taken) return taken.problem();
  auto session = std::make_shared<Session>(id, std::move(taken->state), surroundings, taken->idle_s);
  session->reserve_seat(taken->driver);
  if (!insert(session)) {
    keeper_->release(*session);
    return too_many();
  }
  log_event(LogLevel::kInfo, "session_taken_up", {{"session", id}});
  surroundings.metrics.session_taken_up();
  session->begin();
  return session;
}

/// Null if there is none.
std::shared_ptr<Session> SessionStore::take_out(const std::string& id) {
  std::lock_guard lock(mutex_);
  const auto found = sessions_.find(id);
  if (found == sessions_.end()) return nullptr;
  std::shared_ptr<Session> session = std::move(found->second);
  sessions_.erase(found);
  return session;
}

bool SessionStore::end(const std::string& id) {
  const std::shared_ptr<Session> ended = take_out(id);
  if (!ended) return false;
  log_event(LogLevel::kInfo, "session_ended", {{"session", id}, {"reason", "asked for"}});
  ended->end(protocol::CloseCode::kSessionEnded, "the session was ended", true);
  if (keeper_) keeper_->forget(id);
  return true;
}

/// Another server has them, which took this one for dead: their viewers find them there.
void SessionStore::end_lost() {
  if (!keeper_) return;
  for (const std::string& id : keeper_->keep_house()) {
    const std::shared_ptr<Session> lost = take_out(id);
    if (!lost) continue;
    log_event(LogLevel::kWarning, "session_ended", {{"session", id}, {"reason", "taken up by another server"}});
    lost->end(protocol::CloseCode::kDraining, "another server has taken the session up", true);
    keeper_->forget(id);
  }
}

void SessionStore::keep_house(SteadyTime now) {
  std::vector<std::shared_ptr<Session>> idle, alive;
  {
    std::lock_guard lock(mutex_);
    for (auto it = sessions_.begin(); it != sessions_.end();) {
      const SteadyTime since = it->second->idle_since();
      const bool is_idle = since < now && now - since > std::chrono::duration<double>(it->second->idle_s());
      (is_idle ? idle : alive).push_back(it->second);
      it = is_idle ? sessions_.erase(it) : std::next(it);
    }
  }
  for (const auto& session : idle) {
    log_event(LogLevel::kInfo, "session_ended", {{"session", session->id()}, {"reason", "idle"}});
    session->end(protocol::CloseCode::kSessionEnded, "nobody watched for long", true);
    if (keeper_) keeper_->forget(session->id());
  }
  for (const auto& session : alive) session->audience().check_patience(now);
}

void SessionStore::end_all(protocol::CloseCode code, const std::string& reason, bool reconnect) {
  std::map<std::string, std::shared_ptr<Session>> all;
  {
    std::lock_guard lock(mutex_);
    all.swap(sessions_);
  }
  for (const auto& [id, session] : all) {
    if (keeper_) keeper_->release(*session);
    session->end(code, reason, reconnect);
  }
}

void SessionStore::scenes_changed() const {
  std::map<std::string, std::shared_ptr<Session>> all;
  {
    std::lock_guard lock(mutex_);
    all = sessions_;
  }
  for (const auto& [id, session] : all) session->scenes_changed();
}

std::pair<std::size_t, std::size_t> SessionStore::size() const {
  std::lock_guard lock(mutex_);
  std::pair<std::size_t, std::size_t> sum{sessions_.size(), 0};
  for (const auto& [id, session] : sessions_) sum.second += session->viewers();
  return sum;
}

}  // namespace lightwell
