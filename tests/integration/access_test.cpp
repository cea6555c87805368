// A server that asks for tokens, answers pages from elsewhere, and counts.
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

const std::string kView = "view-token-0123456789", kDrive = "drive-token-0123456789",
                  kUpload = "upload-token-0123456789", kAdmin = "admin-token-0123456789";

ServeOptions options_with_tokens() {
  ServeOptions options = test_options();
  TokenList& tokens = options.access.tokens;
  EXPECT_TRUE(tokens.add(kView, Scope::kView) && tokens.add(kDrive, Scope::kDrive) &&
              tokens.add(kUpload, Scope::kUpload) && tokens.add(kAdmin, Scope::kAdmin));
  return options;
}

class AccessTest : public testing::Test {
 protected:
  AccessTest() : server_(options_with_tokens(), fake_source(std::make_shared<FakeStudio>())) {
    server_.ready().wait();
    while (as(kView, "GET", "/v1/scenes").status != 200) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  Answer as(const std::string& token, const std::string& method, const std::string& target,
            const std::string& body = {}, const std::string& type = "application/json") const {
    return ask(server_.port(), method, target, body, type,
               token.empty() ? "" : "Authorization: Bearer " + token + "\r\n");
  }

  RunningServer server_;
};

TEST_F(AccessTest, WhatIsPublicNeedsNoToken) {
  for (const char* path : {"/", "/app.js", "/healthz", "/readyz", "/v1/openapi.json"})
    EXPECT_EQ(as("", "GET", path).status, 200) << path;
}

TEST_F(AccessTest, EverythingElseNeedsOne) {
  for (const char* path : {"/v1/scenes", "/v1/scenes/cornell", "/v1/sessions/x", "/v1/sessions/x/frame"}) {
    const Answer answer = as("", "GET", path);
    EXPECT_EQ(problem(answer)["status"], 401) << path;
    EXPECT_EQ(answer.field("WWW-Authenticate"), "Bearer realm=\"lightwell\"");
  }
  const Answer guess = as("a-guess-0123456789", "GET", "/v1/scenes");
  EXPECT_EQ(problem(guess)["status"], 401);
  EXPECT_NE(guess.field("WWW-Authenticate").find("invalid_token"), std::string::npos);
}

TEST_F(AccessTest, AScopeAllowsWhatItSays) {
  const std::string session = R"({"scene":"cornell","width":8,"height":8})";
  const std::string glb = triangle_glb();
  const auto statuses = [&](const std::string& token) {
    const std::string id = json::parse(as(kAdmin, "POST", "/v1/sessions", session).body)["id"];
    const std::vector<int> got = {as(token, "GET", "/v1/sessions/" + id + "/frame").status,
                                  as(token, "POST", "/v1/render", session).status,
                                  as(token, "PATCH", "/v1/sessions/" + id, "{}").status,
                                  as(token, "PUT", "/v1/scenes/mine", glb, "model/gltf-binary").status / 100,
                                  as(token, "DELETE", "/v1/sessions/" + id).status};
    as(kAdmin, "DELETE", "/v1/sessions/" + id);
    return got;
  };
  EXPECT_EQ(statuses(kView), (std::vector<int>{200, 403, 403, 4, 403}));
  EXPECT_EQ(statuses(kDrive), (std::vector<int>{200, 200, 200, 4, 204}));
  EXPECT_EQ(statuses(kUpload), (std::vector<int>{200, 403, 403, 2, 403}));
  EXPECT_EQ(statuses(kAdmin), (std::vector<int>{200, 200, 200, 2, 204}));
  const Answer refused = as(kView, "POST", "/v1/sessions", session);
  EXPECT_EQ(problem(refused)["detail"], "this needs a token with the scope drive");
  EXPECT_NE(refused.field("WWW-Authenticate").find("insufficient_scope"), std::string::npos);
}

TEST_F(AccessTest, StreamsTakeTheTokenEitherWayAndAWatcherCannotDrive) {
  const std::string id =
      json::parse(as(kDrive, "POST", "/v1/sessions", R"({"scene":"cornell","width":8,"height":8})").body)["id"];
  Line line(server_.port());
  line.send("GET /v1/sessions/" + id + "/stream HTTP/1.1\r\nHost: a\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n" +
            "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_EQ(problem(read_answer(line))["status"], 401);
  WebSocketClient::Options options;
  options.authorization = "Bearer " + kView;
  StreamClient watcher(server_.port(), id, options);
  ASSERT_EQ(watcher.status(), 101);
  EXPECT_EQ(watcher.hello({{"role", "driver"}})["role"], "viewer");
  watcher.input(1, {{"time_s", 1}});
  EXPECT_EQ(watcher.next_text("error")["problem"]["status"], 403);
  options.authorization.clear();
  options.subprotocol = "lightwell.v1, bearer." + kDrive;
  StreamClient driver(server_.port(), id, options);
  ASSERT_EQ(driver.status(), 101);
  EXPECT_EQ(driver.socket().subprotocol(), "lightwell.v1");
  EXPECT_EQ(driver.hello()["role"], "driver");
}

class CorsTest : public testing::Test {
 protected:
  static ServeOptions options() {
    ServeOptions options = test_options();
    options.access.allowed_origins = {"https://good.example"};
    return options;
  }
  CorsTest() : server_(options(), fake_source(std::make_shared<FakeStudio>())) { server_.ready().wait(); }

  Answer from(const std::string& origin, const std::string& method, const std::string& target,
              const std::string& more = {}) const {
    return ask(server_.port(), method, target, {}, {}, "Origin: " + origin + "\r\n" + more);
  }

  RunningServer server_;
};

TEST_F(CorsTest, PagesOnTheListMayRead) {
  const Answer good = from("https://good.example", "GET", "/healthz");
  EXPECT_EQ(good.field("Access-Control-Allow-Origin"), "https://good.example");
  EXPECT_EQ(good.field("Vary"), "Origin");
  const Answer refused = from("https://good.example", "GET", "/nothing");
  EXPECT_EQ(refused.status, 404);
  EXPECT_EQ(refused.field("Access-Control-Allow-Origin"), "https://good.example");
  EXPECT_EQ(from("https://evil.example", "GET", "/healthz").field("Access-Control-Allow-Origin"), "");
}

TEST_F(CorsTest, PreflightsOfPagesOnTheListAreAnswered) {
  const std::string wish = "Access-Control-Request-Method: PUT\r\n";
  const Answer good = from("https://good.example", "OPTIONS", "/v1/scenes/mine", wish);
  EXPECT_EQ(good.status, 204);
  EXPECT_NE(good.field("Access-Control-Allow-Methods").find("PUT"), std::string::npos);
  EXPECT_NE(good.field("Access-Control-Allow-Headers").find("Authorization"), std::string::npos);
  EXPECT_EQ(good.field("Access-Control-Allow-Origin"), "https://good.example");
  EXPECT_EQ(good.field("Content-Length"), "");
  EXPECT_EQ(from("https://evil.example", "OPTIONS", "/v1/scenes/mine", wish).status, 403);
}

TEST(Cors, IsOffUnlessConfigured) {
  RunningServer server(test_options(), fake_source(std::make_shared<FakeStudio>()));
  const std::string origin = "Origin: https://good.example\r\n";
  EXPECT_EQ(ask(server.port(), "GET", "/healthz", {}, {}, origin).field("Access-Control-Allow-Origin"), "");
  EXPECT_EQ(ask(server.port(), "OPTIONS", "/v1/scenes", {}, {}, origin).status, 403);
}

TEST(Rates, TooManyRequestsAreToldWhenToComeAgain) {
  ServeOptions options = test_options();
  options.access.requests_per_second = 1e-3;
  options.access.request_burst = 3;
  RunningServer server(options, fake_source(std::make_shared<FakeStudio>()));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(ask(server.port(), "GET", "/").status, 200);
  const Answer refused = ask(server.port(), "GET", "/");
  EXPECT_EQ(problem(refused)["status"], 429);
  EXPECT_GT(std::stoi(refused.field("Retry-After")), 900);
  EXPECT_EQ(ask(server.port(), "GET", "/healthz").status, 200);  // who looks after the server is not counted
}

TEST(Hosts, AForeignNameIsMisdirected) {
  RunningServer server(test_options(), fake_source(std::make_shared<FakeStudio>()));
  Line line(server.port());
  line.send("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_EQ(problem(read_answer(line))["status"], 421);
}

TEST(Limits, OfOneScene) {
  ServeOptions options = test_options();
  options.limits.max_triangles = 1;
  RunningServer server(options, fake_source(std::make_shared<FakeStudio>()));
  server.ready().wait();
  while (ask(server.port(), "GET", "/v1/scenes").status != 200)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const std::string glb = "model/gltf-binary";
  EXPECT_EQ(ask(server.port(), "PUT", "/v1/scenes/one", triangle_glb(), glb).status, 201);
  const Answer refused = ask(server.port(), "PUT", "/v1/scenes/two", triangle_glb(2), glb);
  EXPECT_EQ(problem(refused)["status"], 413) << refused.body;
}

}  // namespace
}  // namespace lightwell::test
