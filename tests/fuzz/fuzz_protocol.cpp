// The first byte says who reads the rest. What is read must be written and read back the same; nothing may throw.
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "protocol/codec.h"
#include "protocol/frame_header.h"

namespace lightwell::protocol {
namespace {

[[noreturn]] void fail(std::string_view what) {
  std::cerr << what << '\n';
  std::abort();
}

void check_problem(const Problem& problem) {
  if (problem.status < 400 || problem.status > 499 || problem.detail.empty()) fail("a problem that says nothing");
  if (parse_server_message(serialize(ErrorMessage{problem, 1})).ok() == false) fail("a problem that cannot be sent");
}

template <class T>
void read_text(std::string_view text, Decoded<T> (*parse)(std::string_view)) {
  const Decoded<T> parsed = parse(text);
  if (!parsed) return check_problem(parsed.problem());
  const Decoded<T> again = parse(json_text(to_json(*parsed)));
  if (!again || !(*again == *parsed)) fail("written differently from what was read: " + json_text(to_json(*parsed)));
}

void read_frame(std::span<const std::uint8_t> bytes) {
  const Decoded<DecodedFrame> frame = decode_frame(bytes);
  if (!frame) return check_problem(frame.problem());
  auto written = encode_frame_header(frame->header);
  written[7] = bytes[7];  // flags of the future are not kept
  if (!std::equal(written.begin(), written.end(), bytes.begin())) fail("a frame header written differently");
}

/// name=value&name=value, nothing escaped.
void read_query(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> query;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find('&'));
    const std::size_t equals = std::min(part.find('='), part.size());
    query.emplace_back(part.substr(0, equals), equals < part.size() ? part.substr(equals + 1) : std::string_view());
    text.remove_prefix(std::min(part.size() + 1, text.size()));
  }
  const Decoded<FrameQuery> parsed = parse_frame_query(query);
  if (!parsed) check_problem(parsed.problem());
}

void read_any(std::uint8_t reader, std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  switch (reader % 7) {
    case 0:
      return read_text<ClientMessage>(text, parse_client_message);
    case 1:
      return read_text<ServerMessage>(text, parse_server_message);
    case 2:
      return read_text<RenderRequest>(text, parse_render_request);
    case 3:
      return read_text<SessionRequest>(text, parse_session_request);
    case 4:
      return read_text<SessionPatch>(text, parse_session_patch);
    case 5:
      return read_frame(bytes);
    default:
      return read_query(text);
  }
}

}  // namespace
}  // namespace lightwell::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) lightwell::protocol::read_any(data[0], {data + 1, size - 1});
  return 0;
}
