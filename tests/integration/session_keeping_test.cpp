// Sessions outlive their server: another one with the same data folder takes them up.
#include "server/data/database.h"
#include "server/session/edit_log.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using protocol::FrameHeader;

ServeOptions options_in(const DataFolder& folder) {
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  return options;
}

/// One of several servers over a folder.
class Server {
 public:
  explicit Server(const ServeOptions& options) : running_(options, fake_source(std::make_shared<FakeStudio>())) {
    wait_until_ready(running_);
  }

  int port() const { return running_.port(); }
  void drain() { EXPECT_TRUE(running_.drain(kPatience)); }

  Answer ask(const std::string& method, const std::string& target, const json& body = nullptr) const {
    return test::ask(port(), method, target, body.is_null() ? std::string() : body.dump());
  }
  std::string make_session(const json& more = json::object()) const {
    json request{{"scene", "cornell"}, {"width", 64}, {"height", 48}, {"playing", false}};
    request.update(more);
    const Answer answer = ask("POST", "/v1/sessions", request);
    EXPECT_EQ(answer.status, 201) << answer.body;
    return json::parse(answer.body).value("id", "");
  }
  Answer refused_stream(const std::string& session) const {
    Line line(port());
    line.send("GET /v1/sessions/" + session +
              "/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
              "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
    return read_answer(line);
  }
  json session(const std::string& id) const { return json::parse(ask("GET", "/v1/sessions/" + id).body); }

 private:
  RunningServer running_;
};

class SessionKeepingTest : public testing::Test {
 protected:
  const DataFolder folder_;
  const ServeOptions options_ = options_in(folder_);
};

json replace(const std::string& path, const json& value) {
  return {{"op", "replace"}, {"path", path}, {"value", value}};
}

const std::string kLight = "/extensions/KHR_lights_punctual/lights/0/";

TEST_F(SessionKeepingTest, ASessionOfADrainedServerGoesOnAtAnotherAsItWas) {
  auto first = std::make_unique<Server>(options_);
  const Server second(options_);
  const std::string id = first->make_session();
  const json camera{{"eye", {0.25, 1.5, 4.0}}, {"target", {0.0, 1.0, 0.0}}, {"yfov", 0.75}};
  const json patch{{"edits", {replace(kLight + "intensity", 7.0), replace(kLight + "color", {1.0, 0.5, 0.25})}},
                   {"camera", camera},
                   {"settings", {{"samples", 5}, {"bounces", 3}, {"exposure_ev", -2.5}}},
                   {"time_s", 12.5}};
  ASSERT_EQ(first->ask("PATCH", "/v1/sessions/" + id, patch).status, 200);
  json before = first->session(id);
  first->drain();
  json after = second.session(id);
  EXPECT_GT(after["revision"], before["revision"]);
  before.erase("revision");
  after.erase("revision");
  EXPECT_EQ(after, before);
  // The edits are in what it shows, and can be gone on from.
  StreamClient client(second.port(), id);
  EXPECT_EQ(client.hello()["lights"][0]["intensity"], 7.0);
  EXPECT_EQ(
      second.ask("PATCH", "/v1/sessions/" + id, {{"edits", json::array({replace(kLight + "intensity", 8.0)})}}).status,
      200);
  EXPECT_EQ(second.ask("DELETE", "/v1/sessions/" + id).status, 204);
  first = std::make_unique<Server>(options_);
  EXPECT_EQ(first->ask("GET", "/v1/sessions/" + id).status, 404);  // it has ended for all of them
}

TEST_F(SessionKeepingTest, AnUploadedSceneGoesWithItsSession) {
  Server first(options_);
  const Server second(options_);
  ASSERT_EQ(test::ask(first.port(), "PUT", "/v1/scenes/mine", triangle_glb(2), "model/gltf-binary").status, 201);
  const std::string id = first.make_session({{"scene", "mine"}});
  // Replaced since: the session keeps the one that it has.
  ASSERT_EQ(test::ask(first.port(), "PUT", "/v1/scenes/mine", triangle_glb(1), "model/gltf-binary").status, 200);
  first.drain();
  EXPECT_EQ(second.session(id)["scene"], "mine");
  const json second_node = json::array({replace("/nodes/1/translation", {0.0, 1.0, 0.0})});
  EXPECT_EQ(second.ask("PATCH", "/v1/sessions/" + id, {{"edits", second_node}}).status, 200);
}

TEST_F(SessionKeepingTest, WhatPlaysHasGoneOn) {
  Server first(options_);
  const Server second(options_);
  const std::string id = first.make_session({{"scene", "helicopters"}, {"playing", true}, {"time_s", 100.0}});
  first.drain();
  const json session = second.session(id);
  EXPECT_EQ(session["playing"], true);
  EXPECT_GT(session["time_s"], 100.0);
}

TEST_F(SessionKeepingTest, ALivingServersSessionIsNobodyElses) {
  const Server first(options_), second(options_);
  const std::string id = first.make_session();
  const Answer refused = second.ask("GET", "/v1/sessions/" + id);
  EXPECT_EQ(problem(refused)["status"], 503);
  EXPECT_FALSE(refused.field("Retry-After").empty());
  EXPECT_EQ(second.ask("DELETE", "/v1/sessions/" + id).status, 503);
  EXPECT_EQ(second.ask("GET", "/v1/sessions/nobody").status, 404);
  EXPECT_EQ(first.ask("GET", "/v1/sessions/" + id).status, 200);
}

TEST_F(SessionKeepingTest, ASessionOfAServerThatEndedWithoutAWordIsTakenUp) {
  auto first = std::make_unique<Server>(options_);
  const Server second(options_);
  const std::string id = first->make_session({{"time_s", 3.0}});
  first.reset();  // gives nothing up
  EXPECT_TRUE(comes_true([&] { return second.ask("GET", "/v1/sessions/" + id).status == 200; }));
  EXPECT_EQ(second.session(id)["time_s"], 3.0);
}

TEST_F(SessionKeepingTest, AStreamOpenedFirstIsToldToComeAgain) {
  Server first(options_);
  const Server second(options_);
  const std::string id = first.make_session();
  first.drain();
  EXPECT_EQ(second.refused_stream(id).status, 503);
  StreamClient again(second.port(), id);
  EXPECT_EQ(again.status(), 101);
  EXPECT_EQ(again.hello()["session"], id);
  EXPECT_EQ(second.refused_stream("nobody").status, 404);
}

TEST_F(SessionKeepingTest, TheDriversPlaceIsKeptForWhoHasItsToken) {
  Server first(options_);
  const Server second(options_);
  const std::string id = first.make_session();
  StreamClient driver(first.port(), id);
  const json welcome = driver.hello();
  ASSERT_EQ(welcome["role"], "driver");
  driver.input(1, {{"time_s", 42.0}});
  ASSERT_TRUE(driver.frame_where([](const FrameHeader& frame) { return frame.input_seq == 1; }));
  std::thread drainer([&] { first.drain(); });
  EXPECT_EQ(driver.close_code(), 1001);
  drainer.join();
  EXPECT_EQ(second.session(id)["time_s"], 42.0);
  StreamClient stranger(second.port(), id), same(second.port(), id);
  EXPECT_EQ(stranger.hello()["role"], "viewer");
  EXPECT_EQ(same.hello({{"resume", welcome["resume"]}})["role"], "driver");
}

TEST_F(SessionKeepingTest, InputsAreKeptSoonAndOneThatWasTakenForDeadLetsGo) {
  const Server server(options_);
  const std::string id = server.make_session();
  StreamClient driver(server.port(), id);
  driver.hello();
  driver.input(1, {{"edits", json::array({replace(kLight + "intensity", 9.0)})}});
  Database database(folder_.path() / "sessions.sqlite");
  EXPECT_TRUE(comes_true([&] {
    Statement row(database, "SELECT state FROM sessions");
    return row.next() && json::parse(row.text(0))["edits"] == json::array({replace(kLight + "intensity", 9.0)});
  }));
  database.execute("UPDATE sessions SET server = 'another'");
  EXPECT_EQ(driver.next_text("bye")["reconnect"], true);
  EXPECT_EQ(driver.close_code(), 1001);
  EXPECT_EQ(server.ask("GET", "/v1/sessions/" + id).status, 503);
}

TEST_F(SessionKeepingTest, WhatCannotBeReadIsNoSession) {
  Server first(options_);
  const Server second(options_);
  const std::string broken = first.make_session(), other = first.make_session(), good = first.make_session();
  first.drain();
  Database database(folder_.path() / "sessions.sqlite");
  Statement(database, "UPDATE sessions SET state = substr(state, 2) WHERE id = ?1").bind(broken).run();
  Statement(database, "UPDATE sessions SET state = replace(state, '\"cornell\"', '\"gone\"') WHERE id = ?1")
      .bind(other)
      .run();
  EXPECT_EQ(second.ask("GET", "/v1/sessions/" + broken).status, 404);
  EXPECT_EQ(second.ask("GET", "/v1/sessions/" + other).status, 404);
  EXPECT_EQ(second.ask("GET", "/v1/sessions/" + good).status, 200);
}

TEST(EditLog, GivesTheSameSceneAndGrowsOnlyByWhatIsNew) {
  using protocol::Edits;
  const auto list = [](std::initializer_list<json> edits) { return Edits(Edits::array_t(edits)); };
  const json a1 = replace("/a", 1), a2 = replace("/a", 2), b1 = replace("/b", 1), b2 = replace("/b", 2);
  const json added{{"op", "add"}, {"path", "/a"}, {"value", 3}}, test{{"op", "test"}, {"path", "/a"}, {"value", 1}};
  EXPECT_EQ(*with_edits(list({a1}), list({a2})), list({a2}));
  EXPECT_EQ(*with_edits(list({a1, b1}), list({a2, b2})), list({a2, b2}));
  EXPECT_EQ(*with_edits(list({a1, b1}), list({a2})), list({a1, b1, a2}));  // b may depend on a
  EXPECT_EQ(*with_edits(list({added}), list({added})), list({added, added}));
  EXPECT_EQ(*with_edits(list({a1}), list({test})), list({a1}));
  EXPECT_EQ(*with_edits(list({}), list({test, a1})), list({a1}));
  Edits most = Edits::array();
  for (std::size_t i = 0; i < kMostKeptEdits; ++i) most.push_back(replace("/" + std::to_string(i), 1));
  EXPECT_TRUE(with_edits(most, list({replace("/" + std::to_string(kMostKeptEdits - 1), 2)})));
  EXPECT_FALSE(with_edits(most, list({a1})));
}

}  // namespace
}  // namespace lightwell::test
