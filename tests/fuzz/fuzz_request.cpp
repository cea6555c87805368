// An HTTP request, head and body, as a connection hands it on: whatever pieces it comes in.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "server/net/body_decoder.h"

namespace {

using namespace lightwell::net;

constexpr std::uint64_t kMostBodyBytes = 4096;

/// Feeds `bytes` in pieces of `step`; gives the body, or the status of the refusal.
std::pair<std::string, int> decode(const RequestHead& head, std::string_view bytes, std::size_t step) {
  BodyDecoder decoder(head, kMostBodyBytes);
  while (!bytes.empty() && !decoder.done() && !decoder.failure()) {
    const std::size_t taken = decoder.feed(bytes.substr(0, step));
    if (taken == 0 || taken > step) std::abort();
    bytes.remove_prefix(taken);
  }
  if (decoder.size() > kMostBodyBytes) std::abort();
  if (decoder.failure()) return {"", decoder.failure()->status};
  return {decoder.take_body(), 0};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const HeadScan scan = find_head_end(text, 0);
  for (const std::size_t cut : {size / 2, size / 3}) {  // seen in two pieces, it ends where it ended before
    if (scan.state == HeadScan::State::kComplete && cut >= scan.head_bytes) continue;
    const HeadScan first = find_head_end(text.substr(0, cut), 0);
    if (first.state != HeadScan::State::kIncomplete) continue;
    if (find_head_end(text, cut).state != scan.state) std::abort();
  }
  if (scan.state != HeadScan::State::kComplete) return 0;
  const auto parsed = parse_request_head(text.substr(0, scan.head_bytes));
  if (const auto* refusal = std::get_if<Refusal>(&parsed)) {
    if (refusal->status < 400 || refusal->detail.empty()) std::abort();
    return 0;
  }
  const RequestHead& head = std::get<RequestHead>(parsed);
  const std::string_view body = text.substr(scan.head_bytes);
  if (decode(head, body, 1) != decode(head, body, 1000)) std::abort();
  return 0;
}
