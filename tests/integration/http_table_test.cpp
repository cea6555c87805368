// The requests of the public h1spec table, 33 of them, each on a connection of its own: sent to the echo server, as
// that table asks for, and to the server itself, which serves its viewer at "/" and takes nothing there.
#include "tests/integration/echo_application.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::string_literals;

/// What has to wait for more, told from an answer that is late: so long nothing may come.
constexpr std::chrono::milliseconds kSilence(500);

const std::string kHost = "Host: example.com\r\n";
const std::string kGet = "GET / HTTP/1.1\r\n";
const std::string kPost = "POST / HTTP/1.1\r\n" + kHost;

/// Beginnings of a request: no answer before it has ended.
const std::string kBeginnings[] = {"G",
                                   "GET ",
                                   "GET /hello",
                                   "GET /hello ",
                                   "GET /hello HTTP",
                                   "GET /hello HTTP/1.1",
                                   "GET /hello HTTP/1.1\r",
                                   "GET /hello HTTP/1.1\r\n",
                                   "GET /hello HTTP/1.1\r\nHos",
                                   "GET /hello HTTP/1.1\r\nHost:",
                                   "GET /hello HTTP/1.1\r\nHost: ",
                                   "GET /hello HTTP/1.1\r\nHost: localhost",
                                   "GET /hello HTTP/1.1\r\nHost: localhost\r",
                                   "GET /hello HTTP/1.1\r\nHost: localhost\r\n",
                                   "GET /hello HTTP/1.1\r\nHost: localhost\r\n\r"};

const std::string kGood[] = {kGet + kHost + "Expect: 100-continue\r\n\r\n", kGet + kHost + "\r\n",
                             kGet + "hoSt:\texample.com\r\nempty:\r\n\r\n", kGet + kHost + "X-Empty-Header: \r\n\r\n"};

struct Bad {
  std::string request;
  int status;
};

const Bad kBad[] = {
    {"GET / \r\n\r\n", 400},
    {kGet + kHost + "X-Invalid[]: test\r\n\r\n", 400},
    {kGet + "Content-Length: 5\r\n\r\n", 400},
    {kGet + kHost + "Host: example.org\r\n\r\n", 400},
    {kGet + kHost + "Content-Length: -123456789123456789123456789\r\n\r\n", 400},
    {kGet + kHost + "Content-Length: -1234\r\n\r\n", 400},
    {kGet + kHost + "Content-Length: abc\r\n\r\n", 400},
    {kGet + kHost + "X-Bad-Control-Char: test\x07\r\n\r\n", 400},
    {"GET / HTTP/9.9\r\n" + kHost + "\r\n", 505},
    {"Extra lineGET / HTTP/1.1\r\n" + kHost + "\r\n", 400},
    {kGet + kHost + "\rSome-Header: Test\r\n\r\n", 400},
    {kPost + "content-LengtH: 5\r\nTransFer-Encoding: chunked\r\n\r\nc\r\nHellO world1\r\n0\r\n\r\n", 400},
};

const std::string kWithLength = kPost + "Content-Length: 5\r\n\r\nhello";
const std::string kWithChunks = kPost + "Transfer-Encoding: chunked\r\n\r\nc\r\nHellO world1\r\n0\r\n\r\n";

Answer answer_to(int port, const std::string& request) {
  Line line(port);
  line.send(request);
  return read_answer(line);
}

void expect_what_any_server_answers(int port) {
  std::vector<Line> waiting;
  for (const std::string& beginning : kBeginnings) waiting.emplace_back(port).send(beginning);
  for (const std::string& request : kGood) EXPECT_EQ(answer_to(port, request).status, 200) << request;
  for (const Bad& bad : kBad) EXPECT_EQ(answer_to(port, bad.request).status, bad.status) << bad.request;
  std::this_thread::sleep_for(kSilence);
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    EXPECT_EQ(waiting[i].receive_all(std::chrono::milliseconds(0)), "") << kBeginnings[i];
    EXPECT_FALSE(waiting[i].closed()) << kBeginnings[i];
  }
}

TEST(HttpTable, OfAnEchoServer) {
  net::Server server{net::ServerOptions()};
  EchoApplication application(1u << 20);
  server.start(application);
  expect_what_any_server_answers(server.port());
  for (const auto& [request, body] : {std::pair(kWithLength, "hello"s), std::pair(kWithChunks, "HellO world1"s)}) {
    const Answer answer = answer_to(server.port(), request);
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, body);
  }
  server.stop();
}

ServeOptions known_as_example() {
  ServeOptions options = test_options();
  options.access.allowed_hosts = {"example.com"};
  return options;
}

class HttpTableTest : public ServerTest {
 protected:
  HttpTableTest() : ServerTest(known_as_example()) {}
};

TEST_F(HttpTableTest, OfTheServer) {
  expect_what_any_server_answers(server_.port());
  for (const std::string& request : {kWithLength, kWithChunks})
    EXPECT_EQ(problem(answer_to(server_.port(), request))["status"], 404) << request;
}

}  // namespace
}  // namespace lightwell::test
