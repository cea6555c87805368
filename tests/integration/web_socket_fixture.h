// For WebSocket conformance (RFC 6455), byte by byte: frames as they are written down in tables of cases, which are in
// the order of the public Autobahn suite's sections, and a server that echoes.
#pragma once

#include <gtest/gtest.h>

#include "tests/integration/echo_application.h"
#include "tests/integration/line.h"

namespace lightwell::test {

enum Opcode : std::uint8_t { kMore = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };

struct Frame {
  int opcode = kText;
  std::string payload;
  bool fin = true;
  int reserved = 0;  // the three bits
  bool masked = true;

  bool operator==(const Frame&) const = default;
};

inline std::ostream& operator<<(std::ostream& out, const Frame& frame) {
  return out << "frame " << frame.opcode << " of " << frame.payload.size() << " bytes, " << frame.payload.substr(0, 60);
}

inline std::string bytes_of(const Frame& frame) {
  std::string bytes;
  bytes.push_back(static_cast<char>((frame.fin ? 0x80 : 0) | frame.reserved << 4 | frame.opcode));
  const std::size_t size = frame.payload.size();
  const int mask_bit = frame.masked ? 0x80 : 0;
  const int length_bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
  bytes.push_back(static_cast<char>(mask_bit | (length_bytes == 0   ? static_cast<int>(size)
                                                : length_bytes == 2 ? 126
                                                                    : 127)));
  for (int i = length_bytes - 1; i >= 0; --i) bytes.push_back(static_cast<char>(size >> (8 * i)));
  if (!frame.masked) return bytes + frame.payload;
  constexpr char kMask[] = {'\x12', '\x34', '\x56', '\x78'};
  bytes.append(kMask, sizeof(kMask));
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<char>(frame.payload[i] ^ kMask[i % 4]));
  return bytes;
}

/// A server's frame; none when the connection has ended.
inline std::optional<Frame> receive_frame(Line& line) {
  const std::string head = line.receive(2);
  if (head.size() < 2) return {};
  Frame frame;
  frame.masked = (head[1] & 0x80) != 0;
  frame.fin = (head[0] & 0x80) != 0;
  frame.reserved = (head[0] >> 4) & 7;
  frame.opcode = head[0] & 15;
  std::uint64_t size = head[1] & 0x7f;
  const std::string length = line.receive(size == 126 ? 2 : size == 127 ? 8 : 0);
  if (!length.empty()) size = 0;
  for (const char byte : length) size = size << 8 | static_cast<unsigned char>(byte);
  frame.payload = line.receive(size);
  return frame;
}

inline std::string status_payload(int code, const std::string& reason = {}) {
  return std::string{static_cast<char>(code >> 8), static_cast<char>(code)} + reason;
}

inline Frame close_frame(int code, const std::string& reason = {}) {
  return {kClose, status_payload(code, reason)};
}

inline constexpr int kEnds = 1000;

struct Case {
  std::string name;
  std::vector<Frame> sent;
  std::vector<Frame> expected;  // data as whole messages
  int code = kEnds;             // of the closing frame that comes then; 0: one without
  bool ends = code == kEnds;    // because the client says so
};

/// What comes back: data frames joined to messages, pongs, and the closing frame's code.
struct Conversation {
  std::vector<Frame> frames;
  int code = -1;  // none came
};

class WebSocketTest : public testing::Test {
 protected:
  static constexpr std::uint64_t kMostBytes = 1u << 20;

  WebSocketTest() : server_(net::ServerOptions()), application_(kMostBytes) { server_.start(application_); }
  ~WebSocketTest() override { server_.stop(); }

  Line open(const std::string& more_fields = {}) const {
    Line line(server_.port());
    line.send(
        "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
        more_fields + "\r\n");
    const std::string answer = line.receive_until("\r\n\r\n");
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 101 ")) << answer;
    EXPECT_NE(answer.find("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"), std::string::npos) << answer;
    EXPECT_EQ(answer.find("Sec-WebSocket-Extensions"), std::string::npos) << answer;
    return line;
  }

  /// Hears until the other side closes, or `most` messages and pongs have come.
  static Conversation listen(Line& line, std::size_t most = 1'000'000) {
    Conversation heard;
    std::optional<Frame> message;
    while (heard.frames.size() < most) {
      std::optional<Frame> frame = receive_frame(line);
      if (!frame) break;
      EXPECT_FALSE(frame->masked);
      EXPECT_EQ(frame->reserved, 0);
      frame->masked = true;  // as a test writes frames down
      if (frame->opcode == kClose) {
        heard.code = code_in(frame->payload);
        break;
      }
      if (frame->opcode == kMore && message) {
        frame->opcode = message->opcode;
        frame->payload = message->payload + frame->payload;
      }
      if (frame->fin) heard.frames.push_back(*frame);
      if (frame->opcode < kClose) message = frame->fin ? std::nullopt : frame;
    }
    return heard;
  }

  static int code_in(const std::string& payload) {
    if (payload.size() < 2) return 0;
    return static_cast<unsigned char>(payload[0]) << 8 | static_cast<unsigned char>(payload[1]);
  }

  /// In pieces of `chop` bytes; 0: all at once.
  static void send(Line& line, std::string_view bytes, std::size_t chop) {
    if (chop == 0) chop = std::max<std::size_t>(bytes.size(), 1);
    for (; !bytes.empty(); bytes.remove_prefix(std::min(chop, bytes.size()))) line.send(bytes.substr(0, chop));
  }

  void check(const std::vector<Case>& cases, std::size_t chop = 0) const {
    for (const Case& one : cases) {
      SCOPED_TRACE(one.name);
      Line line = open();
      std::string bytes;
      for (const Frame& frame : one.sent) bytes += bytes_of(frame);
      send(line, bytes, chop);
      const std::size_t awaited = one.expected.size();
      Conversation heard = awaited > 0 ? listen(line, awaited) : Conversation();
      EXPECT_EQ(heard.frames, one.expected);
      if (one.ends) line.send(bytes_of(close_frame(1000)));  // once what came before it is answered
      EXPECT_EQ(listen(line).code, one.code);
      line.shut_down_sending();
      line.receive_all();
      EXPECT_TRUE(line.closed());
    }
    Line line = open();  // and the next one is served
    line.send(bytes_of({kText, "next"}));
    EXPECT_EQ(listen(line, 1).frames, (std::vector<Frame>{{kText, "next"}}));
  }

  net::Server server_;
  EchoApplication application_;
};

}  // namespace lightwell::test
