#include "server/net/body_decoder.h"

#include <algorithm>
#include <charconv>

namespace lightwell::net {
namespace {

constexpr std::size_t kMaxLineBytes = 256;      // a chunk's size with its extensions, or one trailer field
constexpr std::size_t kMaxTrailerBytes = 4096;  // trailers are read and forgotten

std::string too_large(std::uint64_t max_bytes) {
  return "the body has more than " + std::to_string(max_bytes) + " bytes";
}

}  // namespace

BodyDecoder::BodyDecoder(const RequestHead& head, std::uint64_t max_bytes) : max_bytes_(max_bytes) {
  if (head.framing == Framing::kChunked) {
    state_ = State::kChunkSize;
  } else if (head.framing == Framing::kLength && head.content_length > 0) {
    state_ = State::kLength;
    remaining_ = head.content_length;
    if (remaining_ > max_bytes) fail(413, too_large(max_bytes));
  }
}

std::size_t BodyDecoder::feed(std::string_view bytes) {
  std::size_t taken = 0;
  while (taken < bytes.size() && !done() && !failure_) {
    const std::string_view rest = bytes.substr(taken);
    if (state_ == State::kLength)
      taken += take_data(rest, State::kDone);
    else if (state_ == State::kChunkData)
      taken += take_data(rest, State::kChunkEnd);
    else
      taken += take_line(rest);
  }
  return taken;
}

void BodyDecoder::fail(int status, std::string detail) {
  failure_ = Refusal{status, std::move(detail), {}};
}

std::size_t BodyDecoder::take_data(std::string_view bytes, State next) {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(remaining_, bytes.size()));
  body_.append(bytes.substr(0, count));
  remaining_ -= count;
  if (remaining_ == 0) state_ = next;
  return count;
}

std::size_t BodyDecoder::take_line(std::string_view bytes) {
  const auto newline = bytes.find('\n');
  const std::size_t count = newline == std::string_view::npos ? bytes.size() : newline + 1;
  if (line_.size() + count > kMaxLineBytes) {
    fail(400, "a line between chunks has more than " + std::to_string(kMaxLineBytes) + " bytes");
    return count;
  }
  line_.append(bytes.substr(0, count));
  if (newline == std::string_view::npos) return count;
  if (!line_.ends_with("\r\n") || line_.find('\r') != line_.size() - 2) {
    fail(400, "a line between chunks does not end in CR LF");
    return count;
  }
  line_.resize(line_.size() - 2);
  line_read();
  line_.clear();
  return count;
}

void BodyDecoder::line_read() {
  switch (state_) {
    case State::kChunkSize:
      return chunk_size_read();
    case State::kChunkEnd:
      if (!line_.empty()) return fail(400, "a chunk is longer than its size says");
      state_ = State::kChunkSize;
      return;
    default:  // a trailer field, or the empty line that ends them
      trailer_bytes_ += line_.size();
      if (line_.empty())
        state_ = State::kDone;
      else if (trailer_bytes_ > kMaxTrailerBytes)
        fail(431, "the trailer is too long");
      return;
  }
}

void BodyDecoder::chunk_size_read() {
  const std::string_view size = std::string_view(line_).substr(0, line_.find(';'));
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), value, 16);
  if (error != std::errc() || end != size.data() + size.size() || size.size() > 15)
    return fail(400, "a chunk's size is not a hexadecimal number");
  if (value > max_bytes_ - body_.size()) return fail(413, too_large(max_bytes_));
  remaining_ = value;
  state_ = value == 0 ? State::kTrailer : State::kChunkData;
}

}  // namespace lightwell::net
