// Keeps this server's sessions in the data folder, and takes up those of servers that are gone.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "server/data/scene_files.h"
#include "server/operations/metrics.h"
#include "server/session/session.h"
#include "server/session/session_archive.h"

namespace lightwell {

/// Thread-safe. A session that cannot be kept goes on all the same; the log says so, and it is counted.
class SessionKeeper {
 public:
  /// data_dir/sessions.sqlite. Throws std::runtime_error that names what cannot be made.
  SessionKeeper(const std::string& data_dir, SceneFiles& scenes, Metrics& metrics);
  ~SessionKeeper();  // writes what has changed
  SessionKeeper(const SessionKeeper&) = delete;
  SessionKeeper& operator=(const SessionKeeper&) = delete;

  /// Writes it now: it survives whatever befalls this server after the call.
  void keep(const Session& session);
  /// Writes it soon, from a thread of the keeper's own: many changes a second are one or a few.
  void changed(std::shared_ptr<const Session> session);
  /// Another server may have it.
  void release(const Session& session);
  /// It has ended.
  void forget(const std::string& id);

  struct TakenUp {
    SessionState state;
    double idle_s = 0.0;
    std::string driver;  // the resume token of who drove
  };
  /// A session that is this server's from here on. Problem: 404 if there is none such, 503 if a server that lives has
  /// it.
  protocol::Decoded<TakenUp> take_up(const std::string& id, const SessionRules& rules);

  /// Called every second. Gives the sessions that were this server's and are another's now: it took this one for dead.
  /// Throws DatabaseError.
  std::set<std::string> keep_house();

 private:
  void run();
  void write(const Session& session, bool and_release);
  void drop(const std::string& id);
  void failed(const std::string& id, const std::string& reason);
  static void say_not_kept(const std::string& id, const std::string& reason);

  SceneFiles& scenes_;
  Metrics& metrics_;
  SessionArchive archive_;

  std::mutex writing_mutex_;  // taken before mutex_
  std::set<std::string> written_;
  std::set<std::string> failing_;  // to be written, the last time that it was tried

  std::mutex mutex_;
  std::condition_variable woken_;
  std::map<std::string, std::shared_ptr<const Session>> changed_;
  bool stopping_ = false;
  std::thread writer_;
};

}  // namespace lightwell
