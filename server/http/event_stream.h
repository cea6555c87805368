// Server-sent events (HTML standard, 9.2) of something that changes: its state whenever it is another than before.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/net/application.h"

namespace lightwell::http {

struct Event {
  std::string name;
  std::string data;      // one line
  bool is_last = false;  // nothing changes after it
};

/// Written as chunks. A comment keeps the line alive while nothing happens.
class EventStream : public net::BodySource {
 public:
  /// What there is to tell now; none ends the stream.
  using Look = std::function<std::optional<Event>()>;
  /// Has `wake` called when there may be something new, until what it gives back goes.
  using Listen = std::function<std::shared_ptr<void>(std::function<void()> wake)>;

  EventStream(Look look, Listen listen);

  std::optional<std::string> next() override;
  void set_waker(std::function<void()> wake) override { listening_ = listen_(std::move(wake)); }

 private:
  const Look look_;
  const Listen listen_;
  std::shared_ptr<void> listening_;
  std::string told_;  // the last event's data
  enum class Stage { kOpen, kEnding, kEnded } stage_ = Stage::kOpen;
  std::chrono::steady_clock::time_point spoke_;
};

}  // namespace lightwell::http
