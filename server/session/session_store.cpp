#include "server/session/session_store.h"

#include "server/operations/log.h"
#include "server/random_id.h"

namespace lightwell {

protocol::Decoded<std::shared_ptr<Session>> SessionStore::add(SessionState state,
                                                              const SessionSurroundings& surroundings, double idle_s) {
  auto session = std::make_shared<Session>(random_id(), std::move(state), surroundings, idle_s);
  std::lock_guard lock(mutex_);
  if (sessions_.size() >= static_cast<std::size_t>(limits_.max_sessions))
    return protocol::make_problem(
        503, "there are " + std::to_string(limits_.max_sessions) + " sessions already, as many as this server serves");
  sessions_.emplace(session->id(), session);
  log_event(LogLevel::kInfo, "session_begun", {{"session", session->id()}});
  return session;
}

std::shared_ptr<Session> SessionStore::find(const std::string& id) {
  std::lock_guard lock(mutex_);
  const auto found = sessions_.find(id);
  if (found == sessions_.end()) return nullptr;
  found->second->touch();
  return found->second;
}

bool SessionStore::end(const std::string& id) {
  std::shared_ptr<Session> ended;
  {
    std::lock_guard lock(mutex_);
    const auto found = sessions_.find(id);
    if (found == sessions_.end()) return false;
    ended = std::move(found->second);
    sessions_.erase(found);
  }
  log_event(LogLevel::kInfo, "session_ended", {{"session", id}, {"reason", "asked for"}});
  ended->end(protocol::CloseCode::kSessionEnded, "the session was ended", true);
  return true;
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
  }
  for (const auto& session : alive) session->audience().check_patience(now);
}

void SessionStore::end_all(protocol::CloseCode code, const std::string& reason, bool reconnect) {
  std::map<std::string, std::shared_ptr<Session>> all;
  {
    std::lock_guard lock(mutex_);
    all.swap(sessions_);
  }
  for (const auto& [id, session] : all) session->end(code, reason, reconnect);
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
