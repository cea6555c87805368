// POST /v1/render: pictures that are asked for once.
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using RenderingsTest = ServerTest;

TEST_F(RenderingsTest, RendersInThreeFormats) {
  const json request{{"scene", "cornell"}, {"width", 32}, {"height", 16}, {"settings", {{"warm_up", 0}}}};
  const Answer png = ask("POST", "/v1/render", request);
  ASSERT_EQ(png.status, 200) << png.body;
  EXPECT_EQ(png.field("Content-Type"), "image/png");
  EXPECT_TRUE(png.body.starts_with("\x89PNG"));
  EXPECT_NE(png.field("Server-Timing").find("shadow-maps;dur=0.250"), std::string::npos);
  EXPECT_EQ(png.field("X-Lightwell-Rays"), "512");
  EXPECT_EQ(png.field("X-Lightwell-Clamped-Share"), "0.125000");

  json jpeg = request;
  jpeg["format"] = "jpeg";
  EXPECT_TRUE(ask("POST", "/v1/render", jpeg).body.starts_with("\xff\xd8\xff"));
  json exr = request;
  exr["format"] = "exr";
  const Answer linear = ask("POST", "/v1/render", exr);
  EXPECT_EQ(linear.field("Content-Type"), "image/x-exr");
  EXPECT_TRUE(linear.body.starts_with("\x76\x2f\x31\x01"));
}

TEST_F(RenderingsTest, AccumulatesAsManyFramesAsAsked) {
  const int before = studio_->pictures;
  const Answer answer =
      ask("POST", "/v1/render",
          {{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"spp_frames", 5}, {"settings", {{"warm_up", 0}}}});
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.field("X-Lightwell-Rays"), "320");
  EXPECT_EQ(studio_->pictures - before, 5);
  const std::vector<FrameRequest> requests = studio_->requests();
  EXPECT_FALSE(requests[requests.size() - 5].accumulate);
  EXPECT_TRUE(requests.back().accumulate);
}

TEST_F(RenderingsTest, UnseenFramesComeBeforeAPictureOfRealtime) {
  const auto requests_of = [this](const json& settings) {
    const std::size_t before = studio_->requests().size();
    const json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"spp_frames", 2}, {"settings", settings}};
    EXPECT_EQ(ask("POST", "/v1/render", request).status, 200);
    std::vector<FrameRequest> requests = studio_->requests();
    requests.erase(requests.begin(), requests.begin() + static_cast<std::ptrdiff_t>(before));
    return requests;
  };
  const std::vector<FrameRequest> requests = requests_of({{"warm_up", 2}});
  ASSERT_EQ(requests.size(), 4u);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    EXPECT_EQ(requests[i].is_unseen, i < 2) << i;
    EXPECT_EQ(requests[i].accumulate, i == 3) << i;
    EXPECT_EQ(requests[i].want_display, i == 3) << i;
  }
  EXPECT_EQ(requests_of(json::object()).size(), 5u) << "three by default";
  EXPECT_EQ(requests_of({{"warm_up", 2}, {"method", "thesis"}}).size(), 2u);
  EXPECT_EQ(requests_of({{"warm_up", 2}, {"view", "normal"}}).size(), 2u) << "is not made by realtime";
}

TEST_F(RenderingsTest, APictureHasTheSettingsThatSessionsBeginWithUnlessItNamesOthers) {
  const auto settings_of = [this](const json& settings) {
    const json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"settings", settings}};
    EXPECT_EQ(ask("POST", "/v1/render", request).status, 200);
    return studio_->requests().back().settings;
  };
  const Settings left_out = settings_of(json::object());
  EXPECT_EQ(left_out.method, Method::kRealtime);
  EXPECT_EQ(left_out.bounces, 2);
  const Settings named = settings_of({{"method", "thesis"}});
  EXPECT_EQ(named.method, Method::kThesis);
  EXPECT_EQ(named.bounces, 2);
  EXPECT_EQ(named.patch, 2);
  EXPECT_TRUE(named.denoise);
}

class FewSamplesTest : public ServerTest {
 protected:
  FewSamplesTest() : ServerTest(options()) {}

  static ServeOptions options() {
    ServeOptions options = test_options();
    options.limits.max_samples = 16;
    return options;
  }
};

TEST_F(FewSamplesTest, WhatNamesNoSamplesHasNoMoreThanItMayAskFor) {
  const json session = json::parse(ask("GET", "/v1/sessions/" + make_session()).body);
  EXPECT_EQ(session["settings"]["samples"], 16);
  EXPECT_EQ(ask("POST", "/v1/render", {{"scene", "cornell"}, {"width", 8}, {"height", 8}}).status, 200);
}

TEST_F(RenderingsTest, NamesWhatIsWrongWithARenderRequest) {
  struct Case {
    json change;
    int status;
    std::string pointer;
  };
  const Case cases[] = {
      {{{"scene", "nothing"}}, 422, "/scene"},
      {{{"scene", 1}}, 422, "/scene"},
      {{{"widht", 1}}, 422, "/widht"},
      {{{"width", 0}}, 422, "/width"},
      {{{"width", "wide"}}, 422, "/width"},
      {{{"width", 60000}}, 422, "/width"},
      {{{"height", 5000}}, 422, "/height"},
      {{{"camera", {{"index", 99}}}}, 422, "/camera/index"},
      {{{"settings", {{"samples", 100000}}}}, 422, "/settings/samples"},
      {{{"settings", {{"samples", 0}}}}, 422, "/settings/samples"},
      {{{"settings", {{"method", "magic"}}}}, 422, "/settings/method"},
      {{{"settings", {{"view", "x"}}}}, 422, "/settings/view"},
      {{{"settings", {{"shadow_filter", 4}}}}, 422, "/settings/shadow_filter"},
      {{{"settings", {{"patch", 3}}}}, 422, "/settings/patch"},
      {{{"settings", {{"triangle_groups", 65}}}}, 422, "/settings/triangle_groups"},
      {{{"settings", {{"similarity", "none"}}}}, 422, "/settings/similarity"},
      {{{"settings", {{"view", "bounce"}}}}, 422, "/settings/view_index"},
      {{{"settings", {{"indirect_size", 1}}}}, 422, "/settings/indirect_size"},
      {{{"settings", {{"more", 1}}}}, 422, "/settings/more"},
      {{{"format", "gif"}}, 422, "/format"},
      {{{"spp_frames", 1e9}}, 422, "/spp_frames"},
      {{{"edits", {{{"op", "replace"}, {"path", "/nodes/99999/translation"}, {"value", {0, 0, 0}}}}}}, 422, "/edits/0"},
      {{{"edits", "none"}}, 422, "/edits"},
  };
  for (const Case& bad : cases) {
    json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}};
    request.update(bad.change);
    const Answer answer = ask("POST", "/v1/render", request);
    EXPECT_EQ(answer.status, bad.status) << request;
    EXPECT_EQ(problem(answer).value("pointer", ""), bad.pointer) << answer.body;
  }
  for (const char* text : {"", "{", "[1]", "nonsense", "{\"scene\":NaN}", "\xff"}) {
    const Answer answer = ask("POST", "/v1/render", std::string(text));
    EXPECT_GE(answer.status, 400) << text;
    EXPECT_LE(answer.status, 422) << text;
    problem(answer);
  }
}

TEST_F(RenderingsTest, AFailedPictureIsAProblem) {
  studio_->failing = true;
  const Answer answer = ask("POST", "/v1/render", {{"scene", "cornell"}, {"width", 8}, {"height", 8}});
  EXPECT_EQ(problem(answer)["status"], 422);
  studio_->failing = false;
  EXPECT_EQ(ask("POST", "/v1/render", {{"scene", "cornell"}, {"width", 8}, {"height", 8}}).status, 200);
}

TEST_F(RenderingsTest, ARenderIsCalledOffWhenItsClientLeaves) {
  studio_->render_ms = 30;
  constexpr int kFrames = 4000;  // two minutes
  {
    Line closed(server_.port()), broken(server_.port());
    for (Line* line : {&closed, &broken})
      line->send(post_text("/v1/render", R"({"scene":"cornell","width":8,"height":8,"spp_frames":4000})"));
    EXPECT_TRUE(comes_true([this] { return metric("lightwell_renders_waiting") == 2; }));
    broken.reset();
  }
  EXPECT_TRUE(comes_true([this] { return metric("lightwell_renders_waiting") == 0; }));
  EXPECT_LT(studio_->pictures, kFrames);
  const std::string metrics = ask("GET", "/metrics").body;
  EXPECT_NE(metrics.find(R"(route="/v1/render",status="499"} 2)"), std::string::npos) << metrics;
  EXPECT_EQ(metrics.find("status=\"500"), std::string::npos) << metrics;
}

TEST_F(RenderingsTest, AClientThatHasClosedItsSideGetsItsPicture) {
  studio_->held = true;
  Line line(server_.port());
  line.send(post_text("/v1/render", R"({"scene":"cornell","width":8,"height":8})"));
  line.shut_down_sending();
  EXPECT_EQ(line.receive_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  studio_->held = false;
  EXPECT_EQ(read_answer(line).status, 200);
}

TEST_F(RenderingsTest, QuickRequestsDoNotWaitBehindLongOnes) {
  studio_->render_ms = 20;
  std::vector<Line> lines;
  for (int i = 0; i < 12; ++i)
    lines.emplace_back(server_.port())
        .send(post_text("/v1/render", R"({"scene":"cornell","width":8,"height":8,"spp_frames":1000})"));
  EXPECT_EQ(ask("GET", "/healthz").status, 200);
  EXPECT_LT(studio_->pictures, 1000);  // not even the first is done
}

}  // namespace
}  // namespace lightwell::test
