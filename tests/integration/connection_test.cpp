// The connection layer with an application of the test's own behind it.
#include <gtest/gtest.h>

#include <deque>
#include <mutex>
#include <thread>

#include "server/net/server.h"
#include "tests/integration/line.h"
#include "tests/integration/stream_client.h"

namespace lightwell::net {
namespace {

using namespace std::chrono_literals;
using test::Answer;
using test::comes_true;
using test::Line;
using test::read_answer;
using test::WebSocketClient;

std::string response(int status, const std::string& body, bool keep_alive) {
  return "HTTP/1.1 " + std::to_string(status) + " Word\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
         (keep_alive ? "" : "Connection: close\r\n") + "\r\n" + body;
}

/// Sends every message back.
class Echo : public WebSocketHandler {
 public:
  void opened(std::shared_ptr<WebSocketLink> link) override { link_ = std::move(link); }
  void received_text(std::string_view text) override {
    if (text == "close")
      waiting_.push_back(CloseMessage{4321, "as you wish"});
    else
      waiting_.push_back(TextMessage{std::string(text)});
    link_->wake();
  }
  void received_binary(std::string_view bytes) override {
    auto payload = std::make_shared<const std::vector<std::uint8_t>>(bytes.begin(), bytes.end());
    waiting_.push_back(BinaryMessage{"head:", std::move(payload)});
    link_->wake();
  }
  Outgoing next() override {
    if (waiting_.empty()) return {};
    Outgoing message = std::move(waiting_.front());
    waiting_.pop_front();
    return message;
  }
  void closed() override { link_.reset(); }

 private:
  std::shared_ptr<WebSocketLink> link_;
  std::deque<Outgoing> waiting_;
};

/// Six bytes, two at a time, as they are let go.
class Drip : public BodySource {
 public:
  std::optional<std::string> next() override {
    std::lock_guard lock(mutex_);
    if (sent_ == 3) return {};
    if (sent_ == ready_) return std::string();
    return std::string(2, static_cast<char>('a' + sent_++));
  }
  void set_waker(std::function<void()> wake) override {
    std::lock_guard lock(mutex_);
    wake_ = std::move(wake);
  }
  void let_go() {
    std::lock_guard lock(mutex_);
    ++ready_;
    if (wake_) wake_();
  }

 private:
  std::mutex mutex_;
  std::function<void()> wake_;
  int ready_ = 0, sent_ = 0;
};

/// Answers with what was asked: "/slow" after a while, "/long" when let go, "/drip" bit by bit, "/refused" never.
class TestApplication : public Application {
 public:
  ~TestApplication() override {
    for (std::thread& thread : threads_) thread.join();
  }

  Admission admit(const RequestHead& head, const Peer&) override {
    if (head.wants_web_socket) return WebSocketAdmission{std::make_shared<Echo>(), "echo", 1000};
    if (head.path == "/refused") return Refusal{403, "no", {}};
    return HttpAdmission{1'000'000};
  }

  void answer(Request request, std::function<void(net::Answer)> done) override {
    std::lock_guard lock(mutex_);
    threads_.emplace_back([this, request = std::move(request), done = std::move(done)] {
      if (request.head.path == "/slow") std::this_thread::sleep_for(200ms);
      if (request.head.path == "/long") {
        ++long_begun;
        comes_true([&] { return let_go || *request.gone; });
        if (*request.gone) ++long_called_off;
      }
      if (request.head.path == "/drip") {
        drip = std::make_shared<Drip>();
        return done({"HTTP/1.1 200 OK\r\nContent-Length: 6\r\n\r\n", drip});
      }
      done({response(200, request.head.method + " " + request.head.path + " " + request.body, request.keep_alive), {}});
    });
  }

  std::string refusal_response(const Refusal& refusal, bool keep_alive, const RequestHead*) override {
    return response(refusal.status, refusal.detail, keep_alive);
  }

  std::atomic<int> long_begun = 0, long_called_off = 0;  // requests for /long
  std::atomic<bool> let_go = false;                      // ends them
  std::shared_ptr<Drip> drip;

 private:
  std::mutex mutex_;
  std::vector<std::thread> threads_;
};

/// The application goes before the server, and the server has stopped by then: late answers go nowhere.
class ConnectionTest : public testing::Test {
 protected:
  explicit ConnectionTest(const ServerOptions& options = {}) : server_(options) { server_.start(application_); }
  ~ConnectionTest() override { server_.stop(); }

  int port() const { return server_.port(); }
  bool all_are_closed() const {
    return comes_true([this] { return server_.connections() == 0; });
  }

  Server server_;
  TestApplication application_;
};

ServerOptions quick_options() {
  ServerOptions options;
  options.head_timeout = 300ms;
  options.idle_timeout = 600ms;
  options.stall_timeout = 300ms;
  return options;
}

class ImpatientConnectionTest : public ConnectionTest {
 protected:
  ImpatientConnectionTest() : ConnectionTest(quick_options()) {}
};

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
  EXPECT_TRUE(server_.drain(test::kPatience));
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
  EXPECT_EQ(test::ask(port(), "GET", "/a").status, 200);
  EXPECT_LT(std::chrono::steady_clock::now() - start, ServerOptions().head_timeout);  // waits for none of them to end
}

TEST(ConnectionLimit, TurnsAwayWhatIsTooMany) {
  ServerOptions options;
  options.max_connections = 2;
  Server server(options);
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

TEST(Listening, NamesAPortThatIsTaken) {
  const Server first{ServerOptions()};
  ServerOptions options;
  options.port = first.port();
  try {
    const Server second(options);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("127.0.0.1:" + std::to_string(first.port())), std::string::npos);
  }
}

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
  EXPECT_EQ(test::ask(port(), "GET", "/a").status, 200);
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

TEST(Loopback, IsTheOnlyPlaceWithoutLeave) {
  ServerOptions options;
  options.host = "0.0.0.0";
  try {
    const Server server(options);
    FAIL() << "it listens";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("0.0.0.0:0: other machines reach this address"), std::string::npos);
  }
  options.loopback_only = false;
  EXPECT_GT(Server(options).port(), 0);
}

TEST(Tls, NamesAFileThatIsNoCertificate) {
  ServerOptions options;
  options.tls_certificate = options.tls_key = "/dev/null";
  try {
    const Server server(options);
    FAIL() << "it listens";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/null"), std::string::npos);
  }
}

}  // namespace
}  // namespace lightwell::net
