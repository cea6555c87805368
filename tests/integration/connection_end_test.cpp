// How connections end, and who is left waiting: stalls, clients that leave, a drain, too many at once.
#include "tests/integration/connection_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::chrono_literals;

net::ServerOptions quick_options() {
  net::ServerOptions options;
  options.head_timeout = 300ms;
  options.idle_timeout = 600ms;
  options.stall_timeout = 300ms;
  return options;
}

class ImpatientConnectionTest : public ConnectionTest {
 protected:
  ImpatientConnectionTest() : ConnectionTest(quick_options()) {}
};

TEST_F(ImpatientConnectionTest, ClosesWhatStalls) {
  Line idle(port()), half_head(port()), half_body(port());
  half_head.send("GET / HT");
  half_body.send("POST /x HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhel");
  for (Line* line : {&half_head, &half_body, &idle}) {
    const std::string answer = line->receive_all();
    EXPECT_TRUE(line == &idle ? answer.empty() : answer.starts_with("HTTP/1.1 408 ")) << answer;
    EXPECT_TRUE(line->closed());
  }
}

TEST_F(ConnectionTest, AClientThatHasClosedItsSideIsAnswered) {
  Line quick(port()), slow(port()), old(port());
  quick.send("GET /quick HTTP/1.1\r\nHost: a\r\n\r\n");
  slow.send("GET /long HTTP/1.1\r\nHost: a\r\n\r\n");
  old.send("GET /long HTTP/1.0\r\nHost: a\r\n\r\n");
  for (Line* line : {&quick, &slow, &old}) line->shut_down_sending();
  EXPECT_EQ(read_answer(quick).body, "GET /quick ");
  EXPECT_EQ(slow.receive_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");  // is it still there? It is
  application_.let_go = true;
  EXPECT_EQ(read_answer(slow).body, "GET /long ");
  EXPECT_TRUE(old.receive_until("\r\n\r\n").starts_with("HTTP/1.1 200 "));  // HTTP/1.0 knows no interim responses
  EXPECT_EQ(application_.long_called_off, 0);
}

TEST_F(ConnectionTest, TellsTheWorkerWhenTheClientHasLeft) {
  Line broken(port());
  {
    Line closed(port());
    closed.send("GET /long HTTP/1.1\r\nHost: a\r\n\r\n");
    broken.send("GET /long HTTP/1.1\r\nHost: a\r\n\r\n");
    EXPECT_TRUE(comes_true([this] { return application_.long_begun == 2; }));
    broken.reset();
  }
  EXPECT_TRUE(comes_true([this] { return application_.long_called_off == 2; }));
  EXPECT_TRUE(all_are_closed());
}

TEST_F(ConnectionTest, DrainLetsARequestEndAndClosesTheRest) {
  Line idle(port()), busy(port());
  busy.send("GET /long HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_TRUE(comes_true([this] { return application_.long_begun == 1; }));
  std::thread worker([this] {
    EXPECT_TRUE(comes_true([this] { return server_.connections() == 1; }));  // the idle one is closed
    application_.let_go = true;
  });
  EXPECT_TRUE(server_.drain(kPatience));
  worker.join();
  EXPECT_EQ(read_answer(busy).status, 200);
  idle.receive_all();
  EXPECT_TRUE(idle.closed());
  EXPECT_THROW(Line{port()}, std::runtime_error);
}

TEST_F(ConnectionTest, IdleAndHalfwayConnectionsDelayNobody) {
  std::vector<Line> lines;
  for (int i = 0; i < 200; ++i) lines.emplace_back(port());
  for (int i = 0; i < 200; ++i) lines.emplace_back(port()).send("GET /half HTTP/1.1\r\nHos");
  for (int i = 0; i < 100; ++i)
    lines.emplace_back(port()).send("POST /x HTTP/1.1\r\nHost: a\r\nContent-Length: 9\r\n\r\nabc");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(ask(port(), "GET", "/a").status, 200);
  EXPECT_LT(std::chrono::steady_clock::now() - start,
            net::ServerOptions().head_timeout);  // waits for none of them to end
}

TEST(ConnectionLimit, TurnsAwayWhatIsTooMany) {
  net::ServerOptions options;
  options.max_connections = 2;
  net::Server server(options);
  TestApplication application;
  server.start(application);
  Line first(server.port()), second(server.port());
  EXPECT_TRUE(comes_true([&] { return server.connections() == 2; }));
  Line third(server.port());
  EXPECT_EQ(read_answer(third).status, 503);
  first.send("GET /a HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(read_answer(first).status, 200);
  server.stop();
}

}  // namespace
}  // namespace lightwell::test
