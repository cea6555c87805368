// A WebSocket client for tests: blocking, with a time limit on everything.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "tests/integration/line.h"

namespace lightwell::test {

struct Message {
  bool is_text = true;
  std::string bytes;
};

class WebSocketClient {
 public:
  struct Options {
    std::string subprotocol = "lightwell.v1";  // empty: none is asked for
    std::string origin;
    int receive_buffer_bytes = 0;    // of the socket; 0: as the system likes
    std::string authorization = {};  // the field's value; empty: none
  };

  WebSocketClient();
  ~WebSocketClient();
  WebSocketClient(WebSocketClient&&) noexcept;

  /// The status of the answer to the handshake: 101 when it is open.
  int open(int port, const std::string& target, const Options& options);
  int open(int port, const std::string& target) { return open(port, target, Options()); }
  const std::string& subprotocol() const;

  void send_text(const std::string& text);
  void send_binary(const std::string& bytes);
  /// Bytes as they are, past the WebSocket's framing.
  void send_raw(const std::string& bytes);

  /// None when nothing came in time, or the other side has closed.
  std::optional<Message> receive(std::chrono::milliseconds limit = kPatience);
  /// The other side's close code; 0 while open, 1006 if it went without one.
  int close_code() const;
  std::string close_reason() const;
  void close();
  /// Drops the connection without a word.
  void cut();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightwell::test
