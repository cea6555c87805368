// WebSocket conformance: frames, and the messages that they make up.
#include "tests/integration/web_socket_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::string_literals;

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
