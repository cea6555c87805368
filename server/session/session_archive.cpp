#include "server/session/session_archive.h"

#include <chrono>
#include <cmath>

#include "server/random_id.h"

namespace lightwell {
namespace {

using Lock = std::lock_guard<std::mutex>;

constexpr std::int64_t kDeadAfterS = 5;  // without a beat

// `server`: whose it is; empty: nobody's. `seen_s`: when that server last lived.
constexpr const char* kSchema = R"(
  PRAGMA journal_mode = WAL;
  PRAGMA synchronous = NORMAL;
  CREATE TABLE IF NOT EXISTS sessions(id TEXT PRIMARY KEY, server TEXT NOT NULL, seen_s INTEGER NOT NULL,
    idle_s INTEGER NOT NULL, scene_digest TEXT NOT NULL, state TEXT NOT NULL);
)";

std::int64_t unix_seconds() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

SessionArchive::SessionArchive(const std::filesystem::path& file) : database_(file), server_(random_id()) {
  database_.set_up(kSchema);
}

void SessionArchive::write(const std::string& id, const KeptSession& session) {
  write(id, session, server_);
}

void SessionArchive::release(const std::string& id, const KeptSession& session) {
  write(id, session, {});
}

void SessionArchive::write(const std::string& id, const KeptSession& session, const std::string& server) {
  Lock lock(mutex_);
  Statement(database_,
            "INSERT INTO sessions(id, server, seen_s, idle_s, scene_digest, state) VALUES(?1, ?2, ?3, ?4, ?5, ?6)"
            " ON CONFLICT(id) DO UPDATE SET server = ?2, seen_s = ?3, scene_digest = ?5, state = ?6 WHERE server = ?7")
      .bind(id)
      .bind(server)
      .bind(unix_seconds())
      .bind(static_cast<std::int64_t>(std::ceil(session.request.idle_s.value_or(0.0))))
      .bind(session.scene_digest)
      .bind(text_of(session))
      .bind(server_)
      .run();
}

void SessionArchive::remove(const std::string& id) {
  Lock lock(mutex_);
  Statement(database_, "DELETE FROM sessions WHERE id = ?1 AND server = ?2").bind(id).bind(server_).run();
}

std::variant<SessionArchive::NotThere, SessionArchive::Elsewhere, KeptSession> SessionArchive::claim(
    const std::string& id) {
  Lock lock(mutex_);
  std::string text;
  {
    Statement row(database_, "SELECT state FROM sessions WHERE id = ?1");
    if (!row.bind(id).next()) return NotThere();
    text = row.text(0);
  }
  const auto session = parse_kept_session(text);  // before it is taken: another version may read what this one cannot
  if (!session) return NotThere();
  const std::int64_t now_s = unix_seconds();
  Statement(database_,
            "UPDATE sessions SET server = ?2, seen_s = ?3 WHERE id = ?1 AND (server IN ('', ?2) OR seen_s < ?4)"
            " AND state = ?5")
      .bind(id)
      .bind(server_)
      .bind(now_s)
      .bind(now_s - kDeadAfterS)
      .bind(text)
      .run();
  if (database_.changes() == 0) return Elsewhere();
  return *session;
}

bool SessionArchive::uses_scene(const std::string& scene_digest) {
  Lock lock(mutex_);
  Statement row(database_, "SELECT 1 FROM sessions WHERE scene_digest = ?1 LIMIT 1");
  return row.bind(scene_digest).next();
}

SessionArchive::Beat SessionArchive::beat() {
  Lock lock(mutex_);
  const std::int64_t now_s = unix_seconds();
  Beat beat;
  Statement own(database_, "UPDATE sessions SET seen_s = ?2 WHERE server = ?1 RETURNING id");
  own.bind(server_).bind(now_s);
  while (own.next()) beat.own.insert(own.text(0));
  Statement left(database_, "DELETE FROM sessions WHERE seen_s + max(idle_s, ?2) < ?1 RETURNING scene_digest");
  left.bind(now_s).bind(kDeadAfterS);
  while (left.next()) beat.scenes_let_go.insert(left.text(0));
  return beat;
}

}  // namespace lightwell
