// The head of an HTTP/1.x request, read strictly (RFC 9110, RFC 9112): what two readers could understand differently is
// refused. Pure: text in, values out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lightwell::net {

/// Why a request is not served; becomes a problem document.
struct Refusal {
  int status = 400;
  std::string detail;                                       // one sentence for people
  std::vector<std::pair<std::string, std::string>> fields;  // further header fields of the answer: Allow, Retry-After
};

struct HeaderField {
  std::string name;   // lower case
  std::string value;  // without surrounding white space
};

enum class Framing { kNone, kLength, kChunked };

struct RequestHead {
  std::string method;
  std::string path;   // percent-decoded, begins with "/"; "*" for OPTIONS *
  std::string query;  // as sent, without "?"
  int minor_version = 1;
  std::vector<HeaderField> fields;
  Framing framing = Framing::kNone;
  std::uint64_t content_length = 0;  // with Framing::kLength
  bool keep_alive = true;            // never for HTTP/1.0: nobody needs it there
  bool expects_continue = false;
  bool wants_web_socket = false;  // a complete and valid WebSocket handshake

  /// A field's value by lower-case name, the first if there are several; empty if there is none.
  std::string_view field(std::string_view name) const;
};

struct HeadLimits {
  std::size_t max_bytes = 16 * 1024;  // the whole head
  std::size_t max_target_bytes = 4096;
  std::size_t max_fields = 64;
};

/// Looks for the end of a head in `text`, of which the first `scanned` bytes were looked at before without finding it.
struct HeadScan {
  enum class State { kIncomplete, kComplete, kBroken } state = State::kIncomplete;
  std::size_t head_bytes = 0;  // when complete: with the empty line
};
HeadScan find_head_end(std::string_view text, std::size_t scanned);

/// The answer to a head that does not end within its limit.
Refusal head_too_large(const HeadLimits& limits);

/// Reads a complete head, its empty line included.
std::variant<RequestHead, Refusal> parse_request_head(std::string_view text, const HeadLimits& limits = {});

}  // namespace lightwell::net
