// How sessions end, and what they outlive.
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using protocol::FrameHeader;

using SessionLifeTest = ServerTest;

TEST_F(SessionLifeTest, EndsStreamsWithTheirSession) {
  const std::string session = make_session();
  StreamClient client(server_.port(), session);
  client.hello();
  EXPECT_EQ(ask("DELETE", "/v1/sessions/" + session).status, 204);
  const json bye = client.next_text("bye");
  EXPECT_EQ(bye["reconnect"], true);
  EXPECT_EQ(client.close_code(), 4001);
  EXPECT_TRUE(comes_true([this] { return studio_->views == 0; }));
}

TEST_F(SessionLifeTest, ReportsAPictureThatFailsAndGoesOnWhenItCan) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  studio_->failing = true;
  client.input(1, {{"settings", {{"samples", 3}}}});
  EXPECT_EQ(client.next_text("error")["problem"]["status"], 422);
  studio_->failing = false;
  client.input(2, {{"settings", {{"samples", 4}}}});
  EXPECT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.input_seq == 2; }));
}

TEST_F(SessionLifeTest, SessionsGoOnWhenTheDeviceIsLost) {
  const std::string session = make_session({{"scene", "helicopters"}});
  StreamClient client(server_.port(), session);
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.frame >= 3; }));
  studio_->losing = true;
  EXPECT_EQ(client.next_text("error")["problem"]["status"], 503);
  client.input(1, {{"settings", {{"samples", 5}}}});
  EXPECT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.input_seq == 1; }));
  EXPECT_EQ(studio_->sources, 2);
  studio_->losing = true;  // whichever picture it hits: a request is tried again by itself
  EXPECT_EQ(ask("POST", "/v1/render", {{"scene", "cornell"}, {"width", 8}, {"height", 8}}).status, 200);
  EXPECT_NE(ask("GET", "/metrics").body.find("lightwell_device_rebuilds_total 2\n"), std::string::npos);
}

TEST_F(SessionLifeTest, DrainTellsViewersToReconnectAndEndsRequestsInFlight) {
  StreamClient client(server_.port(), make_session({{"playing", false}}));
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.is_final; }));
  studio_->held = true;
  const int begun = studio_->begun;
  Line render(server_.port());
  render.send(post_text("/v1/render", R"({"scene":"cornell","width":8,"height":8})"));
  ASSERT_TRUE(comes_true([&] { return studio_->begun > begun; }));
  std::thread drainer([this] { EXPECT_TRUE(server_.drain(kPatience)); });
  EXPECT_EQ(client.next_text("bye")["reconnect"], true);
  EXPECT_EQ(client.close_code(), 1001);
  studio_->held = false;
  EXPECT_EQ(read_answer(render).status, 200);
  drainer.join();
}

TEST_F(SessionLifeTest, ASessionMayAskToEndSooner) {
  const std::string brief = make_session({{"idle_s", 1}}), usual = make_session();
  EXPECT_TRUE(comes_true([this] { return metric("lightwell_sessions") == 1; }));
  EXPECT_EQ(ask("GET", "/v1/sessions/" + brief).status, 404);
  EXPECT_EQ(json::parse(ask("GET", "/v1/sessions/" + usual).body)["idle_s"], 600);
}

ServeOptions soon_forgotten() {
  ServeOptions options = test_options();
  options.limits.session_idle_s = 0.5;
  return options;
}

class IdleTest : public ServerTest {
 protected:
  IdleTest() : ServerTest(soon_forgotten()) {}
};

TEST_F(IdleTest, SessionsNobodyWantsEnd) {
  const std::string watched = make_session();
  StreamClient client(server_.port(), watched);
  client.hello();
  const std::string idle = make_session();
  EXPECT_TRUE(comes_true([this] { return metric("lightwell_sessions") == 1; }));
  EXPECT_EQ(ask("GET", "/v1/sessions/" + idle).status, 404);
  EXPECT_EQ(ask("GET", "/v1/sessions/" + watched).status, 200);
}

}  // namespace
}  // namespace lightwell::test
