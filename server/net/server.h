// The one port: accepts connections and serves an Application over them, HTTP/1.1 and WebSocket.
// Sockets are owned by Asio and cost no thread; the application's work is done elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "server/net/application.h"
#include "server/net/request_head.h"

namespace lightwell::net {

struct ServerOptions {
  std::string host = "127.0.0.1";  // a name or an address
  int port = 0;                    // 0: any free port
  bool loopback_only = true;       // refuses to listen on an address that other machines reach
  std::string tls_certificate;     // a PEM file with the certificate and its chain; empty: no TLS
  std::string tls_key;             // a PEM file with its private key
  int io_threads = 2;
  int max_connections = 4096;  // beyond them a connection is answered with 503 and closed
  HeadLimits head;
  std::uint64_t max_bodies_bytes = 1024ull << 20;   // of all requests being received or answered; beyond: 503
  std::chrono::milliseconds head_timeout{10'000};   // from a head's first byte to its last
  std::chrono::milliseconds idle_timeout{60'000};   // between requests
  std::chrono::milliseconds stall_timeout{10'000};  // a body or an answer must move on; see `transfer_deadline`
  double min_bytes_per_s = 16.0 * 1024;             // and on the whole be at least this fast
  std::chrono::milliseconds web_socket_idle_timeout{60'000};  // pings are sent after half of it
};

class Server {
 public:
  /// Listens from here on; connections wait until `start`. Throws std::runtime_error that names the address.
  explicit Server(const ServerOptions& options);
  ~Server();  // stops
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Called once. `application` is not touched any more after `stop`.
  void start(Application& application);

  /// The port listened on.
  int port() const;
  /// The address listened on, as a URL's host: 127.0.0.1, [::1].
  std::string host_in_url() const;
  int connections() const;

  /// Closes what is idle and lets requests being served end; true when all connections have ended in time. Until then
  /// new ones may still ask one thing each, such as how the server does; after it none are accepted.
  bool drain(std::chrono::milliseconds limit);

  /// Ends the I/O threads. WebSockets that are open are told that they are closed, and everything of the application's
  /// is let go; it is not called any more, and answers it still gives go nowhere.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightwell::net
