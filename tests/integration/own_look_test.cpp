// Watchers who look for themselves: with a camera and a size of their own, in their session's share of the time.
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::chrono_literals;
using protocol::FrameHeader;

json camera_at(double x) {
  return {{"eye", {x, 1, 5}}, {"target", {0, 1, 0}}, {"yfov", 0.8}};
}

json look(std::uint32_t seq, const json& members) {
  json message{{"type", "look"}, {"seq", seq}};
  message.update(members);
  return message;
}

class OwnLookTest : public ServerTest {
 protected:
  OwnLookTest() : OwnLookTest(test_options()) {}
  explicit OwnLookTest(const ServeOptions& options)
      : ServerTest(options),
        session_(make_session()),
        driver_(server_.port(), session_),
        watcher_(server_.port(), session_) {
    driver_.hello();
    watcher_.hello({{"role", "viewer"}});
  }

  std::uint64_t revision() const { return json::parse(ask("GET", "/v1/sessions/" + session_).body)["revision"]; }

  std::optional<FrameHeader> frame_of_input(StreamClient& client, std::uint32_t seq) {
    return client.frame_where([seq](const FrameHeader& frame) { return frame.input_seq == seq; });
  }

  /// How many pictures of such a width, seen from such an x, have been made.
  long made(int width, float x) const {
    const std::vector<FrameRequest> requests = studio_->requests();
    return std::count_if(requests.begin(), requests.end(), [&](const FrameRequest& request) {
      return request.size_px.x == width && request.camera.world_from_view[3].x == x;
    });
  }

  /// The next message of a type; pictures on the way are acknowledged, so that others follow.
  static json text_of(StreamClient& client, const std::string& type) {
    while (const auto heard = client.next()) {
      if (heard->frame) client.ack(heard->frame->frame);
      if (heard->text.is_object() && heard->text["type"] == type) return heard->text;
    }
    return nullptr;
  }

  json refused(const json& message) {
    watcher_.send(message);
    return text_of(watcher_, "error");
  }

  const std::string session_;
  StreamClient driver_, watcher_;
};

TEST_F(OwnLookTest, HasACameraAndASizeOfItsOwn) {
  driver_.input(1, {{"camera", camera_at(1)}});
  ASSERT_TRUE(frame_of_input(driver_, 1));
  watcher_.send(look(1, {{"camera", camera_at(2)}, {"width", 32}, {"height", 24}}));
  const auto own = frame_of_input(watcher_, 1);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->width, 32);
  EXPECT_EQ(own->height, 24);
  EXPECT_EQ(own->scene_revision, revision());
  EXPECT_GT(made(32, 2), 0);
  const auto last = watcher_.frame_where([](const FrameHeader& frame) { return frame.is_final; });
  ASSERT_TRUE(last);  // it is refined as the driver's is
  EXPECT_EQ(last->width, 32);

  // The driver's stays the driver's, and its changes of the scene are seen by both.
  driver_.input(2, {{"settings", {{"samples", 9}}}});
  const auto drivers = frame_of_input(driver_, 2);
  ASSERT_TRUE(drivers);
  EXPECT_EQ(drivers->width, 64);
  const std::uint64_t changed = revision();
  EXPECT_TRUE(watcher_.frame_where(
      [&](const FrameHeader& frame) { return frame.width == 32 && frame.scene_revision == changed; }));
  EXPECT_EQ(made(32, 1), 0);
  EXPECT_EQ(made(64, 2), 0);
}

TEST_F(OwnLookTest, MayFollowTheDriversCameraInAnotherSize) {
  watcher_.send(look(1, {{"width", 16}, {"height", 16}}));
  ASSERT_TRUE(frame_of_input(watcher_, 1));
  driver_.input(1, {{"camera", camera_at(3)}});
  EXPECT_TRUE(comes_true([&] {
    watcher_.frame_where([](const FrameHeader& frame) { return frame.width == 16; });
    return made(16, 3) > 0;
  }));
}

TEST_F(OwnLookTest, SharesTheDriversPicturesAgain) {
  watcher_.send(look(1, {{"camera", camera_at(2)}}));
  ASSERT_TRUE(frame_of_input(watcher_, 1));
  const int views = studio_->views;
  watcher_.send(look(2, json::object()));
  const auto shared = frame_of_input(watcher_, 2);
  ASSERT_TRUE(shared);
  EXPECT_TRUE(comes_true([&] { return studio_->views < views; }));  // what it had on the device is free
  const long own = made(64, 2);
  driver_.input(1, {{"camera", camera_at(4)}});
  std::thread other([&] { EXPECT_TRUE(frame_of_input(driver_, 1)); });
  const std::uint64_t before = shared->scene_revision;
  EXPECT_TRUE(watcher_.frame_where([&](const FrameHeader& frame) { return frame.scene_revision > before; }));
  other.join();
  EXPECT_EQ(made(64, 2), own);
}

TEST_F(OwnLookTest, IsNotToldOfTheDriversCamera) {
  watcher_.send(look(1, {{"camera", camera_at(2)}}));
  ASSERT_TRUE(frame_of_input(watcher_, 1));
  driver_.input(1, {{"camera", camera_at(1)}, {"settings", {{"samples", 9}}}});
  const json state = text_of(watcher_, "state");
  EXPECT_EQ(state["settings"]["samples"], 9);
  EXPECT_FALSE(state.contains("camera"));
}

TEST_F(OwnLookTest, EndsWithTheScene) {
  watcher_.send(look(1, {{"camera", camera_at(2)}, {"width", 32}, {"height", 24}}));
  ASSERT_TRUE(frame_of_input(watcher_, 1));
  driver_.input(1, {{"scene", "helicopters"}});
  EXPECT_TRUE(text_of(watcher_, "state").contains("camera"));
  EXPECT_TRUE(watcher_.frame_where([](const FrameHeader& frame) { return frame.width == 64; }));
}

TEST_F(OwnLookTest, EndsWithItsViewer) {
  watcher_.send(look(1, {{"camera", camera_at(2)}}));
  ASSERT_TRUE(frame_of_input(watcher_, 1));
  const int views = studio_->views;
  watcher_.socket().cut();
  EXPECT_TRUE(comes_true([&] { return studio_->views < views; }));
  driver_.input(1, {{"camera", camera_at(5)}});
  EXPECT_TRUE(frame_of_input(driver_, 1));
}

TEST_F(OwnLookTest, RefusesWhatCannotBe) {
  json error = refused(look(1, {{"camera", {{"index", 99}}}}));
  EXPECT_EQ(error["problem"]["status"], 422);
  EXPECT_EQ(error["problem"]["pointer"], "/camera/index");
  EXPECT_EQ(error["seq"], 1);
  EXPECT_EQ(refused(look(2, {{"width", 5000}}))["problem"]["pointer"], "/width");
  EXPECT_EQ(refused(look(2, {{"width", 32}}))["problem"]["pointer"], "/seq");
  EXPECT_EQ(refused(look(3, {{"settings", json::object()}}))["seq"], 3);  // an unknown member
  driver_.send(look(1, {{"camera", camera_at(2)}}));
  const json drivers = text_of(driver_, "error");
  EXPECT_EQ(drivers["problem"]["status"], 422);
  const std::uint64_t before = revision();
  driver_.input(2, {{"camera", camera_at(1)}});
  EXPECT_TRUE(watcher_.frame_where(  // and goes on sharing the driver's
      [&](const FrameHeader& frame) { return frame.scene_revision > before && frame.width == 64; }));
}

ServeOptions one_look() {
  ServeOptions options = test_options();
  options.limits.max_own_looks = 1;
  return options;
}

class OneLookTest : public OwnLookTest {
 protected:
  OneLookTest() : OwnLookTest(one_look()) {}
};

TEST_F(OneLookTest, SharesTheDriversPicturesWhereThereIsNoRoomForMore) {
  watcher_.send(look(1, {{"width", 32}}));
  ASSERT_TRUE(frame_of_input(watcher_, 1));
  StreamClient second(server_.port(), session_);
  second.hello({{"role", "viewer"}});
  second.send(look(1, {{"width", 16}}));
  EXPECT_EQ(text_of(second, "error")["problem"]["status"], 503);
  driver_.input(1, {{"camera", camera_at(1)}});
  ASSERT_TRUE(comes_true([&] { return made(64, 1) > 0; }));
  const std::uint64_t changed = revision();
  const auto shared = second.frame_where([&](const FrameHeader& frame) { return frame.scene_revision == changed; });
  ASSERT_TRUE(shared);
  EXPECT_EQ(shared->width, 64);
  watcher_.send(look(2, json::object()));  // makes room
  ASSERT_TRUE(frame_of_input(watcher_, 2));
  second.send(look(2, {{"width", 16}}));
  const auto own = frame_of_input(second, 2);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->width, 16);
}

}  // namespace
}  // namespace lightwell::test
