// A plain TCP line to a server under test: bytes out, bytes in, with a time limit on everything.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <thread>

namespace lightwell::test {

/// With what must come, and soon: as long as a machine at its limits may take.
inline constexpr std::chrono::seconds kPatience(60);

/// Asks again and again until `condition` holds; false if it never does.
template <class Condition>
bool comes_true(const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

class Line {
 public:
  /// Connects to 127.0.0.1; throws std::runtime_error.
  explicit Line(int port);
  ~Line();
  Line(Line&& other) noexcept;
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  /// False once the other side has closed.
  bool send(std::string_view bytes);
  /// Up to `limit` for all of it; what came until then, or the end, or `until` was seen.
  std::string receive_until(std::string_view until, std::chrono::milliseconds limit = kPatience);
  /// That many bytes, or what came in time.
  std::string receive(std::size_t bytes, std::chrono::milliseconds limit = kPatience);
  /// Everything until the other side closes. `closed` tells whether it did in time.
  std::string receive_all(std::chrono::milliseconds limit = kPatience);
  bool closed() const { return closed_; }
  /// Closes our side: nothing more is sent, and still read.
  void shut_down_sending();
  /// Ends the connection by a reset.
  void reset();

 private:
  bool receive_some(std::string& into, std::chrono::steady_clock::time_point deadline);

  int socket_ = -1;
  bool closed_ = false;
  std::string rest_;
};

struct Answer {
  int status = 0;  // 0: none came
  std::string head;
  std::string body;

  /// A field's value by its exact name; empty if there is none.
  std::string field(std::string_view name) const;
};

/// Reads one HTTP response, interim ones passed over. `head_only`: to a HEAD request.
Answer read_answer(Line& line, bool head_only = false, std::chrono::milliseconds limit = kPatience);

/// One request on a line of its own.
Answer ask(int port, const std::string& method, const std::string& target, const std::string& body = {},
           const std::string& content_type = "application/json", const std::string& more_fields = {});

}  // namespace lightwell::test
