// How connections end, and who is left waiting: stalls, clients that leave, a drain, too many at once.
#include "tests/integration/connection_fixture.h"
#include "tests/integration/stream_client.h"

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

/// Counts itself while it lives.
class Counted {
 public:
  explicit Counted(std::atomic<int>& count) : count_(count) { ++count_; }
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::atomic<int>& count_;
};

/// Keeps account of its WebSockets and bodies; answers "/later" when it is told to.
class CountingApplication : public EchoApplication {
 public:
  CountingApplication() : EchoApplication(1000) {}

  net::Admission admit(const net::RequestHead& head, const net::Peer& peer) override {
    if (!head.wants_web_socket) return EchoApplication::admit(head, peer);
    return net::WebSocketAdmission{std::make_shared<Socket>(*this), {}, 1000};
  }
  void answer(net::Request request, std::function<void(net::Answer)> done) override {
    if (request.head.path != "/later") return done(unfinished_answer());
    later = std::move(done);
    ++asked_later;
  }
  net::Answer unfinished_answer() {
    return {"HTTP/1.1 200 OK\r\nContent-Length: 6\r\n\r\n", std::make_shared<Body>(*this)};
  }

  std::atomic<int> alive = 0, closed = 0, asked_later = 0;
  std::function<void(net::Answer)> later;

 private:
  struct Socket : EchoSocket {
    explicit Socket(CountingApplication& owner) : application(owner), counted(owner.alive) {}
    void closed() override {
      EchoSocket::closed();
      ++application.closed;
    }
    CountingApplication& application;
    const Counted counted;
  };
  struct Body : Drip {
    explicit Body(CountingApplication& owner) : counted(owner.alive) {}
    const Counted counted;
  };
};

TEST(ConnectionStop, LetsGoOfAllThatIsTheApplications) {
  net::Server server((net::ServerOptions()));
  auto application = std::make_unique<CountingApplication>();
  server.start(*application);
  WebSocketClient web_socket;
  ASSERT_EQ(web_socket.open(server.port(), "/"), 101);
  Line body(server.port()), waiting(server.port());
  body.send("GET /body HTTP/1.1\r\nHost: a\r\n\r\n");
  waiting.send("GET /later HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_TRUE(body.receive_until("\r\n\r\n").starts_with("HTTP/1.1 200 "));
  EXPECT_TRUE(comes_true([&] { return application->asked_later == 1; }));
  EXPECT_EQ(application->alive, 2);
  server.stop();
  EXPECT_EQ(application->alive, 0);
  EXPECT_EQ(application->closed, 1);  // the WebSocket has been told
  application->later(application->unfinished_answer());
  EXPECT_EQ(application->alive, 0);  // late, and kept by nobody
  application.reset();
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
