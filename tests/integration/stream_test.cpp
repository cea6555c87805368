// The frame stream: handshake, messages, and clients that misbehave.
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using protocol::FrameHeader;

using StreamTest = ServerTest;

TEST_F(StreamTest, WelcomesAndSendsFrames) {
  const std::string session = make_session();
  StreamClient client(server_.port(), session);
  ASSERT_EQ(client.status(), 101);
  EXPECT_EQ(client.socket().subprotocol(), "lightwell.v1");
  const json welcome = client.hello();
  EXPECT_EQ(welcome["session"], session);
  EXPECT_EQ(welcome["codec"], "jpeg");
  EXPECT_EQ(welcome["protocol"], 1);
  EXPECT_EQ(welcome["role"], "driver");
  EXPECT_EQ(welcome["scene"], "cornell");
  EXPECT_EQ(welcome["device"], "a fake device");
  EXPECT_EQ(welcome["methods"], json({"thesis", "realtime"}));
  EXPECT_EQ(welcome["limits"]["max_upload_bytes"], 4 << 20);
  EXPECT_FALSE(welcome["lights"].empty());
  EXPECT_FALSE(welcome["scenes"].empty());
  EXPECT_TRUE(protocol::parse_server_message(welcome.dump()).ok());

  std::optional<Heard> heard = client.next();
  while (heard && !heard->frame) heard = client.next();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->frame->frame, 1u);
  EXPECT_EQ(heard->frame->width, 64);
  EXPECT_EQ(heard->frame->input_seq, 0u);
  EXPECT_TRUE(heard->frame->is_key);
  EXPECT_TRUE(heard->payload.starts_with("\xff\xd8\xff"));
  EXPECT_EQ(json::parse(ask("GET", "/v1/sessions/" + session).body)["viewers"], 1);
}

TEST_F(StreamTest, RefusesHandshakesThatDoNotFit) {
  const std::string session = make_session();
  const auto status = [this](const std::string& id, const std::string& more_fields) {
    return ask("GET", "/v1/sessions/" + id + "/stream", "", "",
               "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   more_fields)
        .status;
  };
  EXPECT_EQ(status(session, ""), 101);
  EXPECT_EQ(status("nothing", ""), 404);
  EXPECT_EQ(status(session, "Sec-WebSocket-Protocol: other.v1, lightwell.v1\r\n"), 101);
  EXPECT_EQ(status(session, "Sec-WebSocket-Protocol: other.v1\r\n"), 400);
  EXPECT_EQ(status(session, "Origin: https://evil.example\r\n"), 403);
  EXPECT_EQ(status(session, "Origin: null\r\n"), 403);
  EXPECT_EQ(status(session, "Origin: http://127.0.0.1:" + std::to_string(server_.port()) + "\r\n"), 101);
  const Answer plain = ask("GET", "/v1/sessions/" + session + "/stream");
  EXPECT_EQ(problem(plain)["status"], 426);
  EXPECT_EQ(plain.field("Upgrade"), "websocket");
}

TEST_F(StreamTest, RefusesInputsWithTheirNumberAndGoesOn) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  client.input(1, {{"settings", {{"samples", 0}}}});
  json error = client.next_text("error");
  EXPECT_EQ(error["seq"], 1);
  EXPECT_EQ(error["problem"]["pointer"], "/settings/samples");
  client.input(2, {{"settings", {{"method", "magic"}}}});
  EXPECT_EQ(client.next_text("error")["seq"], 2);
  client.input(3, {{"edits", {{{"op", "replace"}, {"path", "/nodes/x/y"}, {"value", 1}}}}});
  error = client.next_text("error");
  EXPECT_EQ(error["seq"], 3);
  EXPECT_EQ(error["problem"]["pointer"], "/edits/0");
  client.input(2, {{"time_s", 1}});
  EXPECT_EQ(client.next_text("error")["problem"]["pointer"], "/seq");
  client.input(4, {{"time_s", 1}});
  EXPECT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.input_seq == 4; }));
}

TEST_F(StreamTest, ClosesOnBadMessages) {
  const auto code_after = [this](const std::function<void(StreamClient&)>& misbehave, bool greet = true) {
    StreamClient client(server_.port(), make_session());
    if (greet) client.hello();
    misbehave(client);
    return client.close_code();
  };
  EXPECT_EQ(code_after([](StreamClient& client) { client.socket().send_text("nonsense"); }), 4000);
  EXPECT_EQ(code_after([](StreamClient& client) { client.send({{"type", "nothing"}}); }), 4000);
  EXPECT_EQ(code_after([](StreamClient& client) { client.send({{"type", "ping"}}); }), 4000);
  EXPECT_EQ(code_after([](StreamClient& client) { client.socket().send_binary("frame"); }), 4000);
  EXPECT_EQ(code_after([](StreamClient& client) { client.ack(4'000'000'000u); }), 4000);
  EXPECT_EQ(code_after([](StreamClient& client) { client.hello(); }), 4000);
  EXPECT_EQ(code_after([](StreamClient& client) { client.input(1, {{"time_s", 1}}); }, false), 4000);
  EXPECT_EQ(ask("GET", "/healthz").status, 200);
}

TEST_F(StreamTest, RefusesAClientThatTakesNoCodecOfOurs) {
  StreamClient client(server_.port(), make_session());
  EXPECT_TRUE(client.hello({{"codecs", {"av1"}}}).is_null());
  EXPECT_EQ(client.close_code(), 4003);
}

TEST_F(StreamTest, AnswersPings) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  client.send({{"type", "ping"}, {"t", 12.5}});
  EXPECT_EQ(client.next_text("pong")["t"], 12.5);
}

TEST_F(StreamTest, SaysStatsAndPoses) {
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}}));
  client.hello();
  json stats, pose;
  while (stats.is_null() || pose.is_null()) {
    const auto heard = client.next();
    ASSERT_TRUE(heard);
    if (heard->frame)
      client.ack(heard->frame->frame);
    else if (heard->text["type"] == "stats" && heard->text["fps"] > 0)
      stats = heard->text;
    else if (heard->text["type"] == "pose")
      pose = heard->text;
  }
  EXPECT_EQ(stats["stages"][1]["name"], "trace");
  EXPECT_GT(stats["encode_ms"], 0.0);
  EXPECT_FALSE(pose["lights"].empty());
  EXPECT_TRUE(pose["view"].contains("eye"));
}

TEST_F(StreamTest, ClosesAClientThatAcknowledgesNothing) {
  const std::string session = make_session();
  StreamClient deaf(server_.port(), session), good(server_.port(), session);
  deaf.hello();
  good.hello({{"role", "viewer"}});
  EXPECT_TRUE(good.frame_where([](const FrameHeader& frame) { return frame.is_final; }));
  EXPECT_EQ(deaf.close_code(), 4002);
  EXPECT_TRUE(comes_true([&] { return metric("lightwell_viewers") == 1; }));
}

ServeOptions options_without_video() {
  ServeOptions options = test_options();
  options.video = false;
  return options;
}

class WithoutVideoTest : public ServerTest {
 protected:
  WithoutVideoTest() : ServerTest(options_without_video()) {}
};

TEST_F(WithoutVideoTest, AnOperatorMayHaveNoVideo) {
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}}));
  const json welcome = client.hello({{"codecs", {"h264", "jpeg"}}});
  EXPECT_EQ(welcome["codec"], "jpeg");
  EXPECT_EQ(welcome["codecs"], json::array({"jpeg"}));
  const auto frame = client.next_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->codec, protocol::FrameCodec::kJpeg);
  EXPECT_GT(metric("lightwell_pictures_encoded_total{codec=\"jpeg\"}"), 0.0);
  EXPECT_EQ(metric("lightwell_pictures_encoded_total{codec=\"h264\"}"), 0.0);
}

}  // namespace
}  // namespace lightwell::test
