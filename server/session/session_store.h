// All sessions of a server, by id.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/session/session.h"

namespace lightwell {

class SessionKeeper;

/// Thread-safe.
class SessionStore {
 public:
  /// `keeper`: null where nothing is kept; outlives it.
  SessionStore(const ServeLimits& limits, SessionKeeper* keeper) : limits_(limits), keeper_(keeper) {}

  /// Problem: 503 if there are as many as may be.
  protocol::Decoded<std::shared_ptr<Session>> add(SessionState state, const SessionSurroundings& surroundings,
                                                  double idle_s);
  /// Null if it is not here; otherwise it counts as asked for. Does not block.
  std::shared_ptr<Session> find(const std::string& id);
  /// The same, and where it is not here takes up one that was another server's. Problem: 404, 503.
  protocol::Decoded<std::shared_ptr<Session>> find_or_take_up(const std::string& id,
                                                              const SessionSurroundings& surroundings);
  /// Whether sessions may be at other servers, from where they can be taken up.
  bool keeps_sessions() const { return keeper_ != nullptr; }
  /// What it is like now survives this server, if anything is kept.
  void keep(const Session& session) const;
  /// False if there is none.
  bool end(const std::string& id);

  /// Tells all viewers which scenes there are now.
  void scenes_changed() const;

  /// Ends sessions that nobody has wanted for long, and streams whose clients do not keep up. Called every second.
  void keep_house(SteadyTime now);
  /// Ends those that another server has taken up, and says that this one lives. Called every second. Throws
  /// DatabaseError.
  void end_lost();
  /// How many there are, and viewers of them.
  std::pair<std::size_t, std::size_t> size() const;
  /// The server stops: another one may take the sessions up.
  void end_all(protocol::CloseCode code, const std::string& reason, bool reconnect);

 private:
  std::shared_ptr<Session> take_out(const std::string& id);
  bool insert(std::shared_ptr<Session> session);
  protocol::Problem too_many() const;

  const ServeLimits limits_;
  SessionKeeper* const keeper_;
  std::mutex take_up_mutex_;  // one at a time; taken before mutex_
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Session>> sessions_;
};

}  // namespace lightwell
