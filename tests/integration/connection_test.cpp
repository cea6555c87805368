// Requests on a connection, one after another: each is answered or refused, and what follows is read right.
#include "tests/integration/connection_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::chrono_literals;

TEST_F(ConnectionTest, AnswersOneRequestAfterAnotherOnOneLine) {
  Line line(port());
  for (int i = 0; i < 3; ++i) {
    line.send("POST /echo HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhello");
    const Answer answer = read_answer(line);
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, "POST /echo hello");
  }
}

TEST_F(ConnectionTest, AnswersPipelinedRequestsInOrder) {
  Line line(port());
  line.send(
      "GET /a HTTP/1.1\r\nHost: a\r\n\r\nGET /slow HTTP/1.1\r\nHost: a\r\n\r\nGET /b HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(read_answer(line).body, "GET /a ");
  EXPECT_EQ(read_answer(line).body, "GET /slow ");
  EXPECT_EQ(read_answer(line).body, "GET /b ");
}

TEST_F(ConnectionTest, TakesARequestByteByByte) {
  Line line(port());
  for (const char c :
       std::string("POST /x HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n")) {
    ASSERT_TRUE(line.send(std::string(1, c)));
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(read_answer(line).body, "POST /x abc");
}

TEST_F(ConnectionTest, SaysContinueWhenAskedTo) {
  Line line(port());
  line.send("POST /x HTTP/1.1\r\nHost: a\r\nContent-Length: 2\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(line.receive_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  line.send("ab");
  EXPECT_EQ(read_answer(line).body, "POST /x ab");
}

TEST_F(ConnectionTest, RefusesAndCloses) {
  struct Case {
    std::string request;
    int status;
  };
  const Case cases[] = {{"GET / HTTP/1.1\r\n\r\n", 400},
                        {"GET / HTTP/1.1\n\n", 400},
                        {"\x16\x03\x01\x02", 400},
                        {"GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(20'000, 'x'), 431},
                        {"POST /x HTTP/1.1\r\nHost: a\r\nContent-Length: 1000001\r\n\r\n", 413},
                        {"POST /x HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n", 400},
                        {"POST /refused HTTP/1.1\r\nHost: a\r\nContent-Length: 10\r\n\r\n", 403}};
  for (const Case& bad : cases) {
    Line line(port());
    line.send(bad.request);
    const Answer answer = read_answer(line);
    EXPECT_EQ(answer.status, bad.status) << bad.request.substr(0, 60);
    EXPECT_EQ(answer.field("Connection"), "close");
    line.receive_all();
    EXPECT_TRUE(line.closed());
  }
}

TEST_F(ConnectionTest, GoesOnAfterRefusingARequestWithoutBody) {
  Line line(port());
  line.send("GET /refused HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(read_answer(line).status, 403);
  line.send("GET /a HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(read_answer(line).status, 200);
}

TEST_F(ConnectionTest, TheAnswerToAnOversizedBodyArrivesThoughTheBodyIsStillBeingSent) {
  Line line(port());
  line.send("POST /x HTTP/1.1\r\nHost: a\r\nContent-Length: 900000000\r\n\r\n" + std::string(400'000, 'x'));
  EXPECT_EQ(read_answer(line).status, 413);
}

}  // namespace
}  // namespace lightwell::test
