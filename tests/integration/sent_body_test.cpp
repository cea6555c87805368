// Bodies that are sent as they are made.
#include "tests/integration/connection_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::chrono_literals;

TEST_F(ConnectionTest, SendsABodyAsItIsMade) {
  Line line(port());
  line.send("GET /drip HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_NE(line.receive_until("\r\n\r\n").find("Content-Length: 6"), std::string::npos);
  EXPECT_EQ(line.receive(1, 50ms), "");
  for (const char* piece : {"aa", "bb", "cc"}) {
    application_.drip->let_go();
    EXPECT_EQ(line.receive(2), piece);
  }
  line.send("GET /next HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(read_answer(line).body, "GET /next ");
}

TEST_F(ConnectionTest, ABodyEndsWhenItsReaderLeaves) {
  {
    Line line(port());
    line.send("GET /drip HTTP/1.1\r\nHost: a\r\n\r\n");
    line.receive_until("\r\n\r\n");
  }
  application_.drip->let_go();  // what is sent to one who has left comes back as a reset
  EXPECT_TRUE(all_are_closed());
}

TEST_F(ConnectionTest, ABodyGoesOnForAReaderWhoHasClosedItsSide) {
  Line line(port());
  line.send("GET /drip HTTP/1.1\r\nHost: a\r\n\r\n");
  line.shut_down_sending();
  EXPECT_NE(line.receive_until("\r\n\r\n").find("Content-Length: 6"), std::string::npos);
  for (const char* piece : {"aa", "bb", "cc"}) {
    application_.drip->let_go();
    EXPECT_EQ(line.receive(2), piece);
  }
}

}  // namespace
}  // namespace lightwell::test
