// Sessions in an SQLite file that several servers may share: each writes its own, and takes up those whose server has
// died or given them up.
#pragma once

#include <filesystem>
#include <mutex>
#include <set>
#include <string>
#include <variant>

#include "server/data/database.h"
#include "server/session/kept_session.h"

namespace lightwell {

/// Thread-safe. Errors of the database are std::runtime_error.
class SessionArchive {
 public:
  explicit SessionArchive(const std::filesystem::path& file);

  /// Writes a session that is this server's, or is new; one that another has taken up stays as it is.
  void write(const std::string& id, const KeptSession& session);
  /// Writes it a last time: whoever is asked for it may take it up.
  void release(const std::string& id, const KeptSession& session);
  /// Forgets one of this server's.
  void remove(const std::string& id);

  struct NotThere {};
  struct Elsewhere {};  // at a server that lives
  /// The session, which is this server's from here on.
  std::variant<NotThere, Elsewhere, KeptSession> claim(const std::string& id);

  bool uses_scene(const std::string& scene_digest);
  /// Says that this server lives, to be called every second, and forgets sessions that nobody took up for as long as
  /// they may stand idle. Gives the sessions that are this server's, and the digests of the scenes of those forgotten.
  struct Beat {
    std::set<std::string> own, scenes_let_go;
  };
  Beat beat();

 private:
  void write(const std::string& id, const KeptSession& session, const std::string& server);

  std::mutex mutex_;
  Database database_;
  const std::string server_;
};

}  // namespace lightwell
