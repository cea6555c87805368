// Several viewers, several sessions: what they share, and that none hurts another.
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using protocol::FrameHeader;

using StreamViewersTest = ServerTest;

TEST_F(StreamViewersTest, TellsAllViewersWhatChanged) {
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

TEST_F(StreamViewersTest, TellsViewersWhichScenesThereAre) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  EXPECT_EQ(ask("PUT", "/v1/scenes/mine", triangle_glb(), "model/gltf-binary").status, 201);
  EXPECT_EQ(client.next_text("state")["scenes"].back()["name"], "mine");
}

TEST_F(StreamViewersTest, EncodesOncePerPictureAndSharesTheBytes) {
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

TEST_F(StreamViewersTest, ALateViewerGetsTheFinishedPictureAtOnce) {
  const std::string session = make_session();
  StreamClient first(server_.port(), session);
  first.hello();
  ASSERT_TRUE(first.frame_where([](const FrameHeader& frame) { return frame.is_final; }));
  const int pictures = studio_->pictures;
  StreamClient second(server_.port(), session);
  second.hello({{"role", "viewer"}});
  const auto frame = second.next_frame();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->is_final);
  EXPECT_EQ(frame->frame, 1u);
  EXPECT_EQ(studio_->pictures, pictures);
}

TEST_F(StreamViewersTest, AResumedStreamReplacesTheEarlierOne) {
  const std::string session = make_session();
  StreamClient first(server_.port(), session);
  const json welcome = first.hello();
  StreamClient second(server_.port(), session);
  EXPECT_EQ(second.hello({{"resume", welcome["resume"]}})["session"], session);
  EXPECT_EQ(first.close_code(), 4001);
  EXPECT_TRUE(second.next_frame());
}

TEST_F(StreamViewersTest, AClientGoneInMidFrameHurtsNobody) {
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
  EXPECT_TRUE(comes_true([&] { return metric("lightwell_viewers") == 1; }));
}

TEST_F(StreamViewersTest, LongRequestsDoNotStopTheStreams) {
  studio_->render_ms = 5;
  constexpr int kFrames = 2000;
  Line job(server_.port());  // it takes the device for seconds
  job.send(post_text("/v1/render", R"({"scene":"cornell","width":8,"height":8,"spp_frames":2000})"));
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}}));
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.frame >= 20; }));
  EXPECT_LT(studio_->pictures, kFrames);
}

}  // namespace
}  // namespace lightwell::test
