// A whole server in this process: the port and the service behind it. What `serve` runs, and tests.
#pragma once

#include <chrono>

#include "server/net/server.h"
#include "server/service.h"

namespace lightwell {

class RunningServer {
 public:
  /// Listens and answers from here on; pictures come once `ready`. Throws std::runtime_error if the port is taken.
  RunningServer(const ServeOptions& options, MakePictureSource make_source, FrameEncoders encode = {});
  ~RunningServer();  // stops at once, without draining

  int port() const { return net_.port(); }
  /// Where the viewer is: http://127.0.0.1:8080/
  std::string url() const;
  std::shared_future<SourceFacts> ready() const { return service_.ready(); }

  /// Is not ready from here on, and serves as before: time for those who send requests here to notice.
  void announce_drain();
  /// Tells viewers to reconnect elsewhere and lets what is in flight end; true if it did in time.
  bool drain(std::chrono::milliseconds limit);

 private:
  static net::ServerOptions net_options(const ServeOptions& options);

  const std::string base_path_;
  const bool tls_;
  net::Server net_;  // first: a port that is taken is known at once
  Service service_;
};

}  // namespace lightwell
