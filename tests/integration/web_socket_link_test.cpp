// WebSockets between the connection layer and an application.
#include "tests/integration/connection_fixture.h"
#include "tests/integration/stream_client.h"

namespace lightwell::test {
namespace {

TEST_F(ConnectionTest, SpeaksWebSocket) {
  WebSocketClient client;
  ASSERT_EQ(client.open(port(), "/", {"echo", "", 0}), 101);
  EXPECT_EQ(client.subprotocol(), "echo");
  client.send_text("hello");
  client.send_binary(std::string("\0\1", 2));
  EXPECT_EQ(client.receive()->bytes, "hello");
  const auto binary = client.receive();
  EXPECT_FALSE(binary->is_text);
  EXPECT_EQ(binary->bytes, std::string("head:\0\1", 7));
  client.send_text("close");
  EXPECT_FALSE(client.receive());
  EXPECT_EQ(client.close_code(), 4321);
  EXPECT_EQ(client.close_reason(), "as you wish");
}

TEST_F(ConnectionTest, ClosesBrokenWebSocketsAsRfc6455Says) {
  struct Case {
    std::string bytes;
    int code;
  };
  using namespace std::string_literals;
  const std::string mask(4, '\0');
  const Case cases[] = {{"\x81\x05hello"s, 1002},                                      // not masked
                        {"\x83\x80"s + mask, 1002},                                    // an opcode that is not used
                        {"\xc1\x80"s + mask, 1002},                                    // a bit that no extension uses
                        {"\x80\x80"s + mask, 1002},                                    // a continuation of nothing
                        {"\x09\x80"s + mask, 1002},                                    // a fragmented ping
                        {"\x89\xfe\x00\x7e"s + mask + std::string(126, 'x'), 1002},    // a ping too long
                        {"\x81\x82"s + mask + "\xc3\x28"s, 1007},                      // no UTF-8
                        {"\x81\xfe\x07\xd0"s + mask + std::string(2000, 'x'), 1009}};  // too large
  for (const Case& bad : cases) {
    WebSocketClient client;
    ASSERT_EQ(client.open(port(), "/", {"", "", 0}), 101);
    client.send_raw(bad.bytes);
    EXPECT_FALSE(client.receive());
    EXPECT_EQ(client.close_code(), bad.code);
  }
  EXPECT_EQ(ask(port(), "GET", "/a").status, 200);
}

TEST_F(ConnectionTest, JoinsFragmentsAndAnswersPings) {
  using namespace std::string_literals;
  const std::string mask(4, '\0');
  WebSocketClient client;
  ASSERT_EQ(client.open(port(), "/", {"", "", 0}), 101);
  client.send_raw("\x01\x82"s + mask + "he" + "\x89\x80"s + mask + "\x80\x83"s + mask + "llo");
  const auto message = client.receive();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->bytes, "hello");
}

}  // namespace
}  // namespace lightwell::test
