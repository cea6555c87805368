// WebSocket conformance (RFC 6455), byte by byte: a table of cases in the order of the public Autobahn suite's
// sections.
#include <gtest/gtest.h>

#include "tests/integration/echo_application.h"
#include "tests/integration/line.h"

namespace lightwell::test {
namespace {

using namespace std::string_literals;

enum Opcode : std::uint8_t { kMore = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };

struct Frame {
  int opcode = kText;
  std::string payload;
  bool fin = true;
  int reserved = 0;  // the three bits
  bool masked = true;

  bool operator==(const Frame&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Frame& frame) {
  return out << "frame " << frame.opcode << " of " << frame.payload.size() << " bytes, " << frame.payload.substr(0, 60);
}

std::string bytes_of(const Frame& frame) {
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
std::optional<Frame> receive_frame(Line& line) {
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

std::string status_payload(int code, const std::string& reason = {}) {
  return std::string{static_cast<char>(code >> 8), static_cast<char>(code)} + reason;
}

Frame close_frame(int code, const std::string& reason = {}) {
  return {kClose, status_payload(code, reason)};
}

constexpr int kEnds = 1000;

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

const std::string kGreek = "\xce\xba\xe1\xbd\xb9\xcf\x83\xce\xbc\xce\xb5";

TEST_F(WebSocketTest, FramesOfAllSizes) {
  std::vector<Case> cases;
  for (const std::size_t size : {0, 1, 125, 126, 127, 128, 65535, 65536, 1 << 20})
    for (const int opcode : {kText, kBinary}) {
      const Frame frame{opcode, std::string(size, opcode == kText ? '*' : '\xfe')};
      cases.push_back({"size " + std::to_string(size), {frame}, {frame}});
    }
  check(cases);
  cases.pop_back();  // a million bytes one by one prove nothing more
  cases.pop_back();
  check(cases, 997);
}

TEST_F(WebSocketTest, PingsAndPongs) {
  const std::string longest(125, '\xfe');
  std::vector<Frame> ten, ten_back;
  for (int i = 0; i < 10; ++i) {
    ten.push_back({kPing, "ping " + std::to_string(i)});
    ten_back.push_back({kPong, "ping " + std::to_string(i)});
  }
  const std::vector<Case> cases{
      {"empty", {{kPing, ""}}, {{kPong, ""}}},
      {"text", {{kPing, "Hello"}}, {{kPong, "Hello"}}},
      {"bytes", {{kPing, "\x00\xff\xfe"s}}, {{kPong, "\x00\xff\xfe"s}}},
      {"the longest", {{kPing, longest}}, {{kPong, longest}}},
      {"too long", {{kPing, longest + "x"}}, {}, 1002},
      {"a pong nobody asked for", {{kPong, ""}}, {}},
      {"a pong with a payload", {{kPong, "unasked"}, {kPing, "x"}}, {{kPong, "x"}}},
  };
  check(cases);
  check(cases, 1);
  // Pongs may be left out when a newer ping has come (5.5.3): one at a time, all are answered.
  Line line = open();
  for (std::size_t i = 0; i < ten_back.size(); ++i) {
    line.send(bytes_of(ten[i]));
    Frame pong = receive_frame(line).value_or(Frame());
    pong.masked = true;
    EXPECT_EQ(pong, ten_back[i]);
  }
}

TEST_F(WebSocketTest, ReservedBitsAndOpcodes) {
  std::vector<Case> cases;
  for (int bits = 1; bits < 8; ++bits)
    for (const int opcode : {kText, kBinary, kPing, kClose}) {
      Frame frame{opcode, opcode == kClose ? status_payload(1000) : "x"s};
      frame.reserved = bits;
      cases.push_back({"reserved bits " + std::to_string(bits), {frame, {kPing, ""}}, {}, 1002});
    }
  for (const int opcode : {3, 4, 5, 6, 7, 11, 12, 13, 14, 15})
    for (const char* payload : {"", "payload"})
      cases.push_back({"opcode " + std::to_string(opcode), {{opcode, payload}, {kPing, ""}}, {}, 1002});
  cases.push_back({"not masked", {{kText, "x", true, 0, false}}, {}, 1002});
  check(cases);
}

TEST_F(WebSocketTest, Fragments) {
  const Frame begun{kText, "frag1", false}, goes_on{kMore, "frag2", false}, ends{kMore, "frag3"}, empty{kMore, ""};
  const std::vector<Case> cases{
      {"a ping in two", {{kPing, "a", false}, {kMore, "b"}}, {}, 1002},
      {"a pong in two", {{kPong, "a", false}, {kMore, "b"}}, {}, 1002},
      {"two", {begun, ends}, {{kText, "frag1frag3"}}},
      {"three", {begun, goes_on, ends}, {{kText, "frag1frag2frag3"}}},
      {"a ping between", {begun, {kPing, "p"}, ends}, {{kPong, "p"}, {kText, "frag1frag3"}}},
      {"pings between", {begun, {kPing, "p"}, goes_on, {kPong, "q"}, ends}, {{kPong, "p"}, {kText, "frag1frag2frag3"}}},
      {"empty ones", {{kText, "", false}, {kMore, "", false}, empty}, {{kText, ""}}},
      {"bytes", {{kBinary, "a", false}, {kMore, "b"}}, {{kBinary, "ab"}}},
      {"an end without a beginning", {ends}, {}, 1002},
      {"a middle without a beginning", {goes_on, {kText, "x"}}, {}, 1002},
      {"another begun between", {begun, {kText, "frag2"}}, {}, 1002},
      {"another begun in parts", {begun, {kText, "frag2", false}, ends}, {}, 1002},
  };
  check(cases);
  check(cases, 1);
  Line line = open();
  line.send(bytes_of({kText, "whole"}));
  EXPECT_EQ(listen(line, 1).frames, (std::vector<Frame>{{kText, "whole"}}));
  line.send(bytes_of(ends));
  EXPECT_EQ(listen(line).code, 1002);
}

TEST_F(WebSocketTest, TextIsUtf8) {
  std::vector<Case> cases;
  const std::string good[] = {"Hello-\xc2\xb5@\xc3\x9f\xc3\xb6\xc3\xa4\xc3\xbc\xc3\xa0\xc3\xa1-UTF-8!!",
                              kGreek,
                              "\0"s,
                              "\x7f",
                              "\xc2\x80",
                              "\xdf\xbf",
                              "\xe0\xa0\x80",
                              "\xed\x9f\xbf",
                              "\xee\x80\x80",
                              "\xef\xbf\xbd",
                              "\xef\xbf\xbe",
                              "\xef\xbf\xbf",
                              "\xf0\x90\x80\x80",
                              "\xf0\x9f\xbf\xbf",
                              "\xf4\x8f\xbf\xbf"};
  const std::string bad[] = {"\x80",
                             "\xbf",
                             "\xc0\x80",
                             "\xc1\xbf",
                             "\xc3",
                             "\xc3\x28",
                             "\xe0\x80\x80",
                             "\xe0\x9f\xbf",
                             "\xe1\x80",
                             "\xed\xa0\x80",
                             "\xed\xbf\xbf",
                             "\xed\xa0\x80\xed\xb0\x80",
                             "\xf0\x80\x80\x80",
                             "\xf0\x8f\xbf\xbf",
                             "\xf4\x90\x80\x80",
                             "\xf5\x80\x80\x80",
                             "\xf8\x88\x80\x80\x80",
                             "\xfc\x84\x80\x80\x80\x80",
                             "\xfe",
                             "\xff",
                             kGreek + "\xed\xa0\x80" + "edited"};
  for (const std::string& text : good) {
    cases.push_back({"good " + text, {{kText, text}}, {{kText, text}}});
    std::vector<Frame> bytewise{{kText, "", false}};
    for (const char byte : text) bytewise.push_back({kMore, std::string(1, byte), false});
    bytewise.push_back({kMore, ""});
    cases.push_back({"good in pieces " + text, bytewise, {{kText, text}}});
  }
  for (const std::string& text : bad) {
    cases.push_back({"bad " + text, {{kText, text}}, {}, 1007});
    cases.push_back({"bad in two " + text, {{kText, text.substr(0, 1), false}, {kMore, text.substr(1)}}, {}, 1007});
    cases.push_back({"bytes may be anything " + text, {{kBinary, text}}, {{kBinary, text}}});
  }
  check(cases);
  check(cases, 1);
  // It is refused as soon as it cannot become right, not at the message's end.
  Line line = open();
  line.send(bytes_of({kText, kGreek + "\xf4\x90", false}));
  EXPECT_EQ(listen(line).code, 1007);
}

TEST_F(WebSocketTest, Closing) {
  const std::string longest(123, '*');
  std::vector<Case> cases{
      {"without a status", {{kClose, ""}}, {}, 1000, false},
      {"half a status", {{kClose, "\x03"}}, {}, 1002},
      {"a reason", {close_frame(1000, "Hello")}, {}, 1000, false},
      {"the longest reason", {close_frame(1000, longest)}, {}, 1000, false},
      {"too long a reason", {close_frame(1000, longest + "x")}, {}, 1002},
      {"a reason that is no UTF-8", {close_frame(1000, "\xce\xba\xed\xa0\x80")}, {}, 1002},
      {"nothing counts after it", {close_frame(1000), {kText, "late"}, {kPing, "late"}}, {}, 1000, false},
      {"a second one", {close_frame(1000), close_frame(1000)}, {}, 1000, false},
      {"in the midst of a message", {{kText, "x", false}, close_frame(1000)}, {}, 1000, false},
  };
  for (const int code : {1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999})
    cases.push_back({"code " + std::to_string(code), {close_frame(code)}, {}, code, false});
  for (const int code : {0, 999, 1004, 1005, 1006, 1016, 1100, 2000, 2999})
    cases.push_back({"code " + std::to_string(code), {close_frame(code)}, {}, 1002});
  check(cases);
}

TEST_F(WebSocketTest, Limits) {
  const std::string most(kMostBytes, 'x');
  check({{"one byte too many", {{kText, most + "x"}}, {}, 1009},
         {"in pieces", {{kText, most, false}, {kMore, "x"}}, {}, 1009},
         {"as many as may be", {{kBinary, most}}, {{kBinary, most}}}});
  // A length that is announced is believed only as far as bytes come: here none do.
  Line line = open();
  line.send("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0"s);
  line.send(std::string(2 * kMostBytes, 'x'));
  EXPECT_EQ(listen(line).code, 1009);
}

TEST_F(WebSocketTest, ExtensionsAreNotAgreedTo) {
  Line line = open("Sec-WebSocket-Extensions: permessage-deflate; client_max_window_bits\r\n");
  line.send(bytes_of({kText, "plain"}));
  EXPECT_EQ(listen(line, 1).frames, (std::vector<Frame>{{kText, "plain"}}));
}

}  // namespace
}  // namespace lightwell::test
