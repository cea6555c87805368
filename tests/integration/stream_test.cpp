// The frame stream: handshake, window, newest first, refinement, and clients that misbehave.
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::chrono_literals;
using protocol::FrameHeader;

using StreamTest = ServerTest;

json free_camera(double x) {
  return {{"eye", {x, 1, 5}}, {"target", {0, 1, 0}}, {"yfov", 0.8}};
}

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
  EXPECT_EQ(welcome["methods"], json({"thesis"}));
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

TEST_F(StreamTest, KeepsTwoFramesInFlight) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  EXPECT_EQ(client.next_frame()->frame, 1u);
  EXPECT_EQ(client.next_frame()->frame, 2u);
  EXPECT_FALSE(client.next_frame(600ms));
  client.ack(1);
  EXPECT_EQ(client.next_frame()->frame, 3u);
  EXPECT_FALSE(client.next_frame(300ms));
  client.ack(3);  // stands for 2 as well
  EXPECT_EQ(client.next_frame()->frame, 4u);
  EXPECT_EQ(client.next_frame()->frame, 5u);
}

TEST_F(StreamTest, TheNewestInputWins) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader&) { return true; }));
  studio_->render_ms = 50;
  constexpr std::uint32_t kInputs = 40;
  const int before = studio_->pictures;
  for (std::uint32_t seq = 1; seq <= kInputs; ++seq) client.input(seq, {{"camera", free_camera(seq)}});
  std::uint32_t last = 0;
  const auto shown = client.frame_where([&](const FrameHeader& frame) {
    EXPECT_GE(frame.input_seq, last);
    last = frame.input_seq;
    return frame.input_seq == kInputs;
  });
  ASSERT_TRUE(shown);
  EXPECT_LT(studio_->pictures - before, 12);
  EXPECT_FLOAT_EQ(studio_->requests().back().camera.world_from_view[3].x, kInputs);
  EXPECT_GT(shown->scene_revision, kInputs);
}

TEST_F(StreamTest, RefinesWhatStandsStillAndThenRests) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  const auto final_frame = client.frame_where([](const FrameHeader& frame) { return frame.is_final; });
  ASSERT_TRUE(final_frame);
  EXPECT_LE(final_frame->frame, 9u);  // the first and one for each doubling to 64
  const std::vector<FrameRequest> requests = studio_->requests();
  EXPECT_TRUE(requests.back().accumulate);
  EXPECT_EQ(requests.back().time_s, requests[requests.size() - 10].time_s);
  const int pictures = studio_->pictures;
  EXPECT_FALSE(client.next_frame(500ms));
  EXPECT_EQ(studio_->pictures, pictures);

  client.input(1, {{"camera", free_camera(1)}});
  const auto next = client.next_frame();
  ASSERT_TRUE(next);
  EXPECT_FALSE(next->is_final);
  EXPECT_EQ(next->input_seq, 1u);
}

ServeOptions soon_in_reference() {
  ServeOptions options = test_options();
  options.reference_after_s = 0.5;
  return options;
}

class ReferenceStreamTest : public ServerTest {
 protected:
  ReferenceStreamTest() : ServerTest(soon_in_reference()) {}
};

TEST_F(ReferenceStreamTest, WhatStandsStillForLongGoesOverIntoReferenceAndBackAtOnce) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.is_final; }));
  EXPECT_EQ(studio_->requests().back().settings.method, Method::kThesis);
  const auto refined = client.next_frame();  // the first with enough samples
  ASSERT_TRUE(refined);
  EXPECT_FALSE(refined->is_final);
  EXPECT_EQ(studio_->requests().back().settings.method, Method::kReference);
  client.input(1, {{"camera", free_camera(1)}});
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.input_seq == 1; }));
  EXPECT_EQ(studio_->requests().back().settings.method, Method::kThesis);
  EXPECT_FALSE(studio_->requests().back().accumulate);
}

TEST_F(StreamTest, AnyInputAbortsRefinement) {
  studio_->render_ms = 30;  // 64 of them take two seconds
  StreamClient client(server_.port(), make_session());
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.frame >= 3; }));
  const auto start = std::chrono::steady_clock::now();
  client.input(1, {{"settings", {{"samples", 5}}}});
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.input_seq == 1; }));
  EXPECT_LT(std::chrono::steady_clock::now() - start, 300ms);
  EXPECT_FALSE(studio_->requests().back().accumulate);
  EXPECT_EQ(studio_->requests().back().settings.samples, 5);
}

TEST_F(StreamTest, APlayingSceneMovesAndAPausedOneStands) {
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}, {"playing", true}}));
  client.hello();
  const auto first = client.frame_where([](const FrameHeader& frame) { return frame.frame >= 5; });
  const auto later =
      client.frame_where([&](const FrameHeader& frame) { return frame.scene_time_s > first->scene_time_s + 0.2f; });
  ASSERT_TRUE(later);
  client.input(1, {{"playing", false}});
  EXPECT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.is_final; }));
}

TEST_F(StreamTest, AnUnwatchedSessionCostsNothing) {
  const std::string session = make_session({{"scene", "helicopters"}});
  std::this_thread::sleep_for(100ms);
  const int before = studio_->pictures;
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(studio_->pictures, before);
  {
    StreamClient client(server_.port(), session);
    client.hello();
    EXPECT_TRUE(client.next_frame());
  }
  std::this_thread::sleep_for(200ms);
  const int after = studio_->pictures;
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(studio_->pictures, after);
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
    const int code = client.close_code();
    for (int i = 0; i < 100 && ask("DELETE", "/v1/scenes").status == 0; ++i) {
    }
    return code;
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

TEST_F(StreamTest, TellsAllViewersWhatChanged) {
  const std::string session = make_session();
  StreamClient driver(server_.port(), session), watcher(server_.port(), session);
  driver.hello();
  EXPECT_EQ(watcher.hello({{"role", "viewer"}})["role"], "viewer");

  driver.input(1, {{"settings", {{"samples", 9}}}, {"playing", false}});
  const json own = driver.next_text("state");
  EXPECT_EQ(own["seq"], 1);
  EXPECT_EQ(own["settings"]["samples"], 9);
  EXPECT_EQ(own["playing"], false);
  EXPECT_FALSE(own.contains("camera"));
  const json other = watcher.next_text("state");
  EXPECT_FALSE(other.contains("seq"));
  EXPECT_EQ(other["settings"]["samples"], 9);

  EXPECT_EQ(ask("PATCH", "/v1/sessions/" + session, {{"scene", "helicopters"}}).status, 200);
  EXPECT_EQ(driver.next_text("state")["scene"], "helicopters");

  watcher.input(1, {{"time_s", 3}});
  const json error = watcher.next_text("error");
  EXPECT_EQ(error["problem"]["status"], 403);
  EXPECT_EQ(error["seq"], 1);
}

TEST_F(StreamTest, TellsViewersWhichScenesThereAre) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  EXPECT_EQ(ask("PUT", "/v1/scenes/mine", triangle_glb(), "model/gltf-binary").status, 201);
  EXPECT_EQ(client.next_text("state")["scenes"].back()["name"], "mine");
}

TEST_F(StreamTest, EncodesOncePerPictureAndSharesTheBytes) {
  const std::string session = make_session();
  StreamClient first(server_.port(), session), second(server_.port(), session);
  first.hello();
  second.hello({{"role", "viewer"}});
  const auto last = [](const FrameHeader& frame) { return frame.is_final; };
  std::thread other([&] { EXPECT_TRUE(second.frame_where(last)); });
  EXPECT_TRUE(first.frame_where(last));
  other.join();
  EXPECT_LT(studio_->pictures, 2 * 64);
}

TEST_F(StreamTest, ALateViewerGetsTheFinishedPictureAtOnce) {
  const std::string session = make_session();
  StreamClient first(server_.port(), session);
  first.hello();
  ASSERT_TRUE(first.frame_where([](const FrameHeader& frame) { return frame.is_final; }));
  const int pictures = studio_->pictures;
  StreamClient second(server_.port(), session);
  second.hello({{"role", "viewer"}});
  const auto frame = second.next_frame(1s);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->is_final);
  EXPECT_EQ(frame->frame, 1u);
  EXPECT_EQ(studio_->pictures, pictures);
}

TEST_F(StreamTest, FollowsTheDriversWindow) {
  StreamClient client(server_.port(), make_session());
  client.hello({{"width", 48}, {"height", 32}});
  EXPECT_EQ(client.next_frame()->width, 48);
  client.input(1, {{"width", 80}, {"height", 60}});
  const auto frame = client.frame_where([](const FrameHeader& f) { return f.input_seq == 1; });
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->width, 80);
  EXPECT_EQ(frame->height, 60);
}

TEST_F(StreamTest, SaysStatsAndPoses) {
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}}));
  client.hello();
  json stats, pose;
  const auto deadline = std::chrono::steady_clock::now() + 5s;
  while ((stats.is_null() || pose.is_null()) && std::chrono::steady_clock::now() < deadline) {
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

TEST_F(StreamTest, EndsStreamsWithTheirSession) {
  const std::string session = make_session();
  StreamClient client(server_.port(), session);
  client.hello();
  EXPECT_EQ(ask("DELETE", "/v1/sessions/" + session).status, 204);
  const json bye = client.next_text("bye");
  EXPECT_EQ(bye["reconnect"], true);
  EXPECT_EQ(client.close_code(), 4001);
  for (int i = 0; i < 100 && studio_->views > 0; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(studio_->views, 0);
}

TEST_F(StreamTest, AResumedStreamReplacesTheEarlierOne) {
  const std::string session = make_session();
  StreamClient first(server_.port(), session);
  const json welcome = first.hello();
  StreamClient second(server_.port(), session);
  EXPECT_EQ(second.hello({{"resume", welcome["resume"]}})["session"], session);
  EXPECT_EQ(first.close_code(), 4001);
  EXPECT_TRUE(second.next_frame());
}

TEST_F(StreamTest, ClosesAClientThatAcknowledgesNothing) {
  const std::string session = make_session();
  StreamClient deaf(server_.port(), session), good(server_.port(), session);
  deaf.hello();
  good.hello({{"role", "viewer"}});
  EXPECT_TRUE(good.frame_where([](const FrameHeader& frame) { return frame.is_final; }));
  EXPECT_EQ(deaf.close_code(15s), 4002);
  for (int i = 0; i < 100 && json::parse(ask("GET", "/v1/sessions/" + session).body)["viewers"] != 1; ++i)
    std::this_thread::sleep_for(10ms);
  EXPECT_EQ(json::parse(ask("GET", "/v1/sessions/" + session).body)["viewers"], 1);
}

TEST_F(StreamTest, AClientGoneInMidFrameHurtsNobody) {
  const std::string session = make_session({{"scene", "helicopters"}});
  StreamClient good(server_.port(), session);
  good.hello();
  for (int i = 0; i < 5; ++i) {
    StreamClient gone(server_.port(), session);
    gone.hello({{"role", "viewer"}});
    gone.next_frame();
    gone.socket().cut();
  }
  ASSERT_TRUE(good.frame_where([](const FrameHeader& frame) { return frame.frame > 20; }));
  for (int i = 0; i < 100 && json::parse(ask("GET", "/v1/sessions/" + session).body)["viewers"] != 1; ++i)
    std::this_thread::sleep_for(10ms);
  EXPECT_EQ(json::parse(ask("GET", "/v1/sessions/" + session).body)["viewers"], 1);
}

TEST_F(StreamTest, ReportsAPictureThatFailsAndGoesOnWhenItCan) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  studio_->failing = true;
  client.input(1, {{"settings", {{"samples", 3}}}});
  EXPECT_EQ(client.next_text("error")["problem"]["status"], 422);
  studio_->failing = false;
  client.input(2, {{"settings", {{"samples", 4}}}});
  EXPECT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.input_seq == 2; }));
}

TEST_F(StreamTest, SessionsGoOnWhenTheDeviceIsLost) {
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

TEST_F(StreamTest, SessionsShareTheDeviceFairly) {
  studio_->render_ms = 5;
  std::vector<std::thread> threads;
  std::atomic<int> frames[3] = {0, 0, 0};
  std::atomic<bool> stop = false;
  for (std::atomic<int>& count : frames) {
    const std::string session = make_session({{"scene", "helicopters"}});
    threads.emplace_back([&, session] {
      StreamClient client(server_.port(), session);
      client.hello();
      while (!stop)
        if (client.frame_where([](const FrameHeader&) { return true; })) ++count;
    });
  }
  std::this_thread::sleep_for(300ms);
  std::vector<Line> jobs;  // that would take the device for seconds
  for (int i = 0; i < 4; ++i) {
    const std::string body = R"({"scene":"cornell","width":8,"height":8,"spp_frames":1000})";
    jobs.emplace_back(server_.port())
        .send("POST /v1/render HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
              std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  for (std::atomic<int>& count : frames) count = 0;
  std::this_thread::sleep_for(1500ms);
  stop = true;
  for (std::thread& thread : threads) thread.join();
  const auto [least, most] = std::minmax({frames[0].load(), frames[1].load(), frames[2].load()});
  EXPECT_GE(least, most * 0.7);
  EXPECT_GT(least + most, 60);  // a quarter of the time each: 75 in 1.5 seconds at best
}

TEST(Drain, TellsViewersToReconnectAndEndsRequestsInFlight) {
  auto studio = std::make_shared<FakeStudio>();
  RunningServer server(test_options(), fake_source(studio));
  server.ready().wait();
  while (ask(server.port(), "GET", "/v1/scenes").status != 200) std::this_thread::sleep_for(5ms);
  const Answer created = ask(server.port(), "POST", "/v1/sessions", R"({"scene":"cornell"})");
  StreamClient client(server.port(), json::parse(created.body)["id"]);
  client.hello();
  studio->render_ms = 300;
  Line render(server.port());
  const std::string body = R"({"scene":"cornell","width":8,"height":8})";
  render.send("POST /v1/render HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
              std::to_string(body.size()) + "\r\n\r\n" + body);
  std::this_thread::sleep_for(50ms);
  std::thread drainer([&] { EXPECT_TRUE(server.drain(10s)); });
  EXPECT_EQ(client.next_text("bye")["reconnect"], true);
  EXPECT_EQ(client.close_code(), 1001);
  EXPECT_EQ(read_answer(render).status, 200);
  drainer.join();
}

TEST(Idle, SessionsNobodyWantsEnd) {
  ServeOptions options = test_options();
  options.limits.session_idle_s = 0.5;
  RunningServer server(options, fake_source(std::make_shared<FakeStudio>()));
  server.ready().wait();
  while (ask(server.port(), "GET", "/v1/scenes").status != 200) std::this_thread::sleep_for(5ms);
  const std::string idle = json::parse(ask(server.port(), "POST", "/v1/sessions", R"({"scene":"cornell"})").body)["id"];
  const std::string watched =
      json::parse(ask(server.port(), "POST", "/v1/sessions", R"({"scene":"cornell"})").body)["id"];
  StreamClient client(server.port(), watched);
  client.hello();
  std::this_thread::sleep_for(2500ms);
  EXPECT_EQ(ask(server.port(), "GET", "/v1/sessions/" + idle).status, 404);
  EXPECT_EQ(ask(server.port(), "GET", "/v1/sessions/" + watched).status, 200);
}

}  // namespace
}  // namespace lightwell::test
