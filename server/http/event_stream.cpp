#include "server/http/event_stream.h"

#include <fmt/format.h>

namespace lightwell::http {
namespace {

using std::chrono::steady_clock;

constexpr auto kSilence = std::chrono::seconds(15);  // proxies take a line for dead after 30 to 60

std::string chunk_of(const std::string& text) {
  return fmt::format("{:x}\r\n{}\r\n", text.size(), text);
}

}  // namespace

EventStream::EventStream(Look look, Listen listen)
    : look_(std::move(look)), listen_(std::move(listen)), spoke_(steady_clock::now()) {}

std::optional<std::string> EventStream::next() {
  if (stage_ == Stage::kEnded) return {};
  std::optional<Event> event;
  if (stage_ == Stage::kOpen) event = look_();
  if (!event) {
    stage_ = Stage::kEnded;
    return "0\r\n\r\n";
  }
  if (event->data != told_) {
    told_ = event->data;
    spoke_ = steady_clock::now();
    if (event->is_last) stage_ = Stage::kEnding;
    return chunk_of("event: " + event->name + "\ndata: " + event->data + "\n\n");
  }
  if (steady_clock::now() - spoke_ < kSilence) return std::string();
  spoke_ = steady_clock::now();
  return chunk_of(":\n\n");
}

}  // namespace lightwell::http
