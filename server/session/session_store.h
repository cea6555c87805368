// All sessions of a server, by id.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/session/session.h"

namespace lightwell {

/// Thread-safe.
class SessionStore {
 public:
  explicit SessionStore(const ServeLimits& limits) : limits_(limits) {}

  /// Problem: 503 if there are as many as may be.
  protocol::Decoded<std::shared_ptr<Session>> add(SessionState state, const SessionSurroundings& surroundings,
                                                  double idle_s);
  /// Null if there is none; otherwise it counts as asked for.
  std::shared_ptr<Session> find(const std::string& id);
  /// False if there is none.
  bool end(const std::string& id);

  /// Tells all viewers which scenes there are now.
  void scenes_changed() const;

  /// Ends sessions that nobody has wanted for long, and streams whose clients do not keep up. Called every second.
  void keep_house(SteadyTime now);
  /// How many there are, and viewers of them.
  std::pair<std::size_t, std::size_t> size() const;
  void end_all(protocol::CloseCode code, const std::string& reason, bool reconnect);

 private:
  const ServeLimits limits_;
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Session>> sessions_;
};

}  // namespace lightwell
