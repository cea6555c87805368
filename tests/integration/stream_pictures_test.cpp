// Which pictures a stream brings: newest first, never more than its window, finer and finer when still.
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::chrono_literals;
using protocol::FrameHeader;

class StreamPicturesTest : public ServerTest {
 protected:
  std::uint64_t revision(const std::string& session) const {
    return json::parse(ask("GET", "/v1/sessions/" + session).body)["revision"];
  }
};

json free_camera(double x) {
  return {{"eye", {x, 1, 5}}, {"target", {0, 1, 0}}, {"yfov", 0.8}};
}

TEST_F(StreamPicturesTest, KeepsTwoFramesInFlight) {
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

TEST_F(StreamPicturesTest, TheNewestInputWins) {
  const std::string session = make_session();
  StreamClient client(server_.port(), session);
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader&) { return true; }));
  const std::uint64_t before = revision(session);
  const int begun = studio_->begun;
  studio_->held = true;
  constexpr std::uint32_t kInputs = 40;
  client.input(1, {{"camera", free_camera(1)}});
  ASSERT_TRUE(comes_true([&] { return studio_->begun > begun; }));
  for (std::uint32_t seq = 2; seq <= kInputs; ++seq) client.input(seq, {{"camera", free_camera(seq)}});
  ASSERT_TRUE(comes_true([&] { return revision(session) == before + kInputs; }));
  studio_->held = false;
  std::uint32_t last = 0;
  const auto shown = client.frame_where([&](const FrameHeader& frame) {
    EXPECT_GE(frame.input_seq, last);
    last = frame.input_seq;
    return frame.input_seq == kInputs;
  });
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->scene_revision, before + kInputs);
  const std::vector<FrameRequest> requests = studio_->requests();
  EXPECT_FLOAT_EQ(requests.back().camera.world_from_view[3].x, kInputs);
  const auto of_inputs = std::count_if(requests.begin(), requests.end(), [](const FrameRequest& request) {
    return !request.accumulate && request.camera.world_from_view[3].y == 1.0f;
  });
  EXPECT_LE(of_inputs, 3);  // the one that was held, the newest, and whatever was the newest in between
}

TEST_F(StreamPicturesTest, APictureInWhichOnlyTimeGoesOnGivesWayToAnInput) {
  studio_->render_ms = 200;
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}}));
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader&) { return true; }));
  // An input that comes late in a picture, as on a slow machine any may, lets it be finished: one of many does not.
  std::uint32_t seq = 0;
  while (studio_->given_up == 0 && seq < 100) {
    client.input(++seq, {{"camera", free_camera(seq)}});
    ASSERT_TRUE(client.frame_where([&](const FrameHeader& frame) { return frame.input_seq == seq; }));
    client.frame_where([](const FrameHeader&) { return true; });  // one in which only time has gone on
  }
  EXPECT_GT(studio_->given_up, 0);
  EXPECT_EQ(metric("lightwell_frames_given_up_total"), studio_->given_up);
}

TEST_F(StreamPicturesTest, NeverTwoPicturesInARowAreGivenUp) {
  studio_->render_ms = 100;
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}}));
  client.hello();
  std::uint32_t seq = 0;
  for (int frames = 0; frames < 10; ++frames) {
    for (int i = 0; i < 10; ++i) client.input(++seq, {{"camera", free_camera(seq)}});
    const auto frame = client.next_frame();
    ASSERT_TRUE(frame);
    client.ack(frame->frame);
  }
  EXPECT_LE(studio_->given_up_in_a_row, 1);
}

TEST_F(StreamPicturesTest, RefinesWhatStandsStillAndThenRests) {
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
  const auto refined = client.next_frame();  // the first of reference
  ASSERT_TRUE(refined);
  EXPECT_FALSE(refined->is_final);
  const auto is_reference = [](const FrameRequest& request) { return request.settings.method == Method::kReference; };
  std::vector<FrameRequest> requests = studio_->requests();
  const auto first = std::find_if(requests.begin(), requests.end(), is_reference);
  ASSERT_NE(first, requests.end());
  EXPECT_EQ(first - requests.begin(), 1 + 64);  // after the warm-up and the whole refinement
  EXPECT_FALSE(first->accumulate);              // its own paths alone,
  EXPECT_EQ(first->hand_over_frames, 1024u);    // that come into the picture little by little
  client.input(1, {{"camera", free_camera(1)}});
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.input_seq == 1; }));
  requests = studio_->requests();
  const auto moved = std::find_if(requests.begin(), requests.end(), [](const FrameRequest& request) {
    return request.camera.world_from_view[3].x == 1.0f;
  });
  ASSERT_NE(moved, requests.end());
  EXPECT_FALSE(is_reference(*moved));
  EXPECT_FALSE(moved->accumulate);
}

TEST_F(ReferenceStreamTest, ASettingLeavesThePictureToItsMethod) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  client.input(1, {{"settings", {{"hand_over", false}}}});
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.is_final && frame.input_seq == 1; }));
  EXPECT_FALSE(client.next_frame(1500ms));  // long after it would have gone over
}

// Reference has no such view: what stands still is as finished as it can be.
TEST_F(ReferenceStreamTest, ViewsOfSurfacesStay) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  client.input(1, {{"settings", {{"view", "normal"}}}});
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.is_final && frame.input_seq == 1; }));
  EXPECT_FALSE(client.next_frame(1500ms));
}

TEST_F(StreamPicturesTest, AnyInputAbortsRefinement) {
  const std::string session = make_session();
  StreamClient client(server_.port(), session);
  client.hello();
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.frame >= 3; }));
  studio_->held = true;  // in the midst of it
  const std::uint64_t before = revision(session);
  client.input(1, {{"settings", {{"samples", 5}}}});
  ASSERT_TRUE(comes_true([&] { return revision(session) > before; }));
  const std::size_t requests_before = studio_->requests().size();
  studio_->held = false;
  ASSERT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.input_seq == 1; }));
  const std::vector<FrameRequest> requests = studio_->requests();
  const auto changed = std::find_if(requests.begin(), requests.end(),
                                    [](const FrameRequest& request) { return request.settings.samples == 5; });
  ASSERT_NE(changed, requests.end());
  EXPECT_FALSE(changed->accumulate);
  EXPECT_LE(changed - requests.begin(), static_cast<std::ptrdiff_t>(requests_before) + 1);
}

TEST_F(StreamPicturesTest, APlayingSceneMovesAndAPausedOneStands) {
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}, {"playing", true}}));
  client.hello();
  const auto first = client.frame_where([](const FrameHeader& frame) { return frame.frame >= 5; });
  const auto later =
      client.frame_where([&](const FrameHeader& frame) { return frame.scene_time_s > first->scene_time_s + 0.2f; });
  ASSERT_TRUE(later);
  client.input(1, {{"playing", false}});
  EXPECT_TRUE(client.frame_where([](const FrameHeader& frame) { return frame.is_final; }));
}

TEST_F(StreamPicturesTest, AnUnwatchedSessionCostsNothing) {
  const std::string session = make_session({{"scene", "helicopters"}});
  EXPECT_TRUE(studio_->comes_to_rest());
  EXPECT_EQ(studio_->pictures, 1);  // the warm-up
  {
    StreamClient client(server_.port(), session);
    client.hello();
    EXPECT_TRUE(client.next_frame());
  }
  EXPECT_TRUE(studio_->comes_to_rest());
}

TEST_F(StreamPicturesTest, FollowsTheDriversWindow) {
  StreamClient client(server_.port(), make_session());
  client.hello({{"width", 48}, {"height", 32}});
  EXPECT_EQ(client.next_frame()->width, 48);
  client.input(1, {{"width", 80}, {"height", 60}});
  const auto frame = client.frame_where([](const FrameHeader& f) { return f.input_seq == 1; });
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->width, 80);
  EXPECT_EQ(frame->height, 60);
}

TEST_F(StreamPicturesTest, WhatRendersSlowlyMovesInASmallerSizeAndStandsInFull) {
  studio_->render_ms = 300;
  StreamClient client(server_.port(), make_session({{"scene", "helicopters"}, {"playing", true}}));
  client.hello();
  const auto small = client.frame_where([](const FrameHeader& frame) { return frame.width < 64; });
  ASSERT_TRUE(small);
  EXPECT_EQ(small->width, small->height);
  studio_->render_ms = 1;
  client.input(1, {{"playing", false}});
  const auto whole = client.frame_where([](const FrameHeader& frame) { return frame.is_final; });
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->width, 64);
  EXPECT_EQ(whole->height, 64);
}

}  // namespace
}  // namespace lightwell::test
