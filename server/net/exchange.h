// One request's answer on its way from a worker to its connection. Private to the connection layer: includes Asio.
#pragma once

#include <mutex>
#include <optional>
#include <utility>

#include "server/net/transport.h"

namespace lightwell::net {

/// Where a worker leaves the answer for the connection's strand. Outlives both.
class Exchange {
 public:
  explicit Exchange(const Strand& strand) : timer_(strand) {}

  /// From any thread; what comes after `drop` is dropped there.
  void leave(Answer answer) {
    std::lock_guard lock(mutex_);
    if (!dropped_) answer_ = std::move(answer);
  }
  /// Nobody takes the answer any more.
  void drop() {
    std::lock_guard lock(mutex_);
    dropped_ = true;
    answer_.reset();
  }

  // On the strand.

  bool answered() {
    std::lock_guard lock(mutex_);
    return answer_.has_value();
  }
  /// Once answered, the strand's alone.
  Answer& answer() { return *answer_; }

  void signal() {
    woken_ = true;
    timer_.cancel();
  }
  void await_anew() { woken_ = false; }
  /// Until it has been signalled, or for so long.
  Awaitable<void> wait(std::chrono::steady_clock::duration limit) {
    error_code ignored;
    timer_.expires_after(limit);
    if (!woken_) co_await timer_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  }

 private:
  asio::steady_timer timer_;
  bool woken_ = false;
  std::mutex mutex_;
  bool dropped_ = false;
  std::optional<Answer> answer_;
};

}  // namespace lightwell::net
