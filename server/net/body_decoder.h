// A request's body as its framing delimits it, collected up to a limit. Pure: bytes in, body out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/net/request_head.h"

namespace lightwell::net {

/// Feed it what arrives until it is done or has failed.
class BodyDecoder {
 public:
  /// For a request with `head`'s framing. More than `max_bytes` is a failure of status 413, known at once where the
  /// length is announced.
  BodyDecoder(const RequestHead& head, std::uint64_t max_bytes);

  /// Takes what belongs to the body from the front of `bytes`; returns how many bytes were taken.
  std::size_t feed(std::string_view bytes);

  bool done() const { return state_ == State::kDone; }
  const std::optional<Refusal>& failure() const { return failure_; }
  std::size_t size() const { return body_.size(); }
  std::string take_body() { return std::move(body_); }

 private:
  enum class State { kLength, kChunkSize, kChunkData, kChunkEnd, kTrailer, kDone };

  void fail(int status, std::string detail);
  std::size_t take_data(std::string_view bytes, State next);
  std::size_t take_line(std::string_view bytes);
  void line_read();
  void chunk_size_read();

  std::uint64_t max_bytes_;
  State state_ = State::kDone;
  std::uint64_t remaining_ = 0;  // of the length or the chunk
  std::string line_;             // the chunk-size or trailer line being read
  std::size_t trailer_bytes_ = 0;
  std::string body_;
  std::optional<Refusal> failure_;
};

}  // namespace lightwell::net
