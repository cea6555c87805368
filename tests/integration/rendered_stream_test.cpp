// The server with the renderer of this project behind it, on whatever device there is.
#include <map>
#include <numeric>

#include "renderer/image_io/image_io.h"
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::chrono_literals;

class RenderedStreamTest : public testing::Test {
 protected:
  /// One server for all tests: compiling the shaders takes its time.
  static void SetUpTestSuite() {
    ServeOptions options = test_options();
    options.limits.max_sessions = 64;
    server_ = std::make_unique<RunningServer>(options, renderer_source("software", ""));
    server_->ready().get();
    while (test::ask(server_->port(), "GET", "/v1/scenes").status != 200) std::this_thread::sleep_for(5ms);
  }
  static void TearDownTestSuite() { server_.reset(); }

  static Answer post(const std::string& target, const json& body) {
    return ask(server_->port(), "POST", target, body.dump());
  }

  static std::string make_session(json request) {
    request.update({{"width", 96}, {"height", 64}});
    const Answer answer = post("/v1/sessions", request);
    EXPECT_EQ(answer.status, 201) << answer.body;
    return json::parse(answer.body).value("id", "");
  }

  static Image decoded(const std::string& file) {
    const auto image = decode_image(std::as_bytes(std::span(file.data(), file.size())), 1 << 24);
    EXPECT_TRUE(image.ok()) << (image ? "" : image.error().message());
    return image ? *image : Image();
  }

  static std::unique_ptr<RunningServer> server_;
};

std::unique_ptr<RunningServer> RenderedStreamTest::server_;

/// Of the three colours, 0 to 255.
double mean(const Image& image) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    if (i % 4 != 3) sum += image.rgba[i];
  return image.rgba.empty() ? 0.0 : sum / (static_cast<double>(image.rgba.size()) * 0.75);
}

double mean_difference(const Image& a, const Image& b) {
  if (a.rgba.empty() || a.rgba.size() != b.rgba.size()) return 255.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int(a.rgba[i]) - int(b.rgba[i]));
  return sum / (static_cast<double>(a.rgba.size()) * 0.75);
}

json render_request(const json& more = json::object()) {
  json request{
      {"scene", "cornell"}, {"width", 96}, {"height", 64}, {"settings", {{"samples", 8}, {"indirect_size", 32}}}};
  request.update(more, true);
  return request;
}

TEST_F(RenderedStreamTest, APlayingSceneMoves) {
  StreamClient client(server_->port(), make_session({{"scene", "helicopters"}, {"playing", true}}));
  EXPECT_FALSE(client.hello({{"width", 96}, {"height", 64}})["device"].get<std::string>().empty());
  std::map<int, std::vector<Image>> pictures;  // by width: a machine under load gives resolution up
  int width = 96;
  while (pictures[width].size() < 4) {
    const auto heard = client.next(60s);
    ASSERT_TRUE(heard);
    if (!heard->frame) continue;
    client.ack(heard->frame->frame);
    const Image picture = decoded(heard->payload);
    width = picture.size_px.x;
    EXPECT_LE(width, 96);
    EXPECT_NEAR(picture.size_px.y, width * 64.0 / 96.0, 1.0);
    EXPECT_GT(heard->frame->render_ms, 0.0f);
    pictures[width].push_back(picture);
  }
  EXPECT_GT(mean(pictures[width].back()), 10.0);
  EXPECT_GT(mean_difference(pictures[width].front(), pictures[width].back()), 0.5);
}

TEST_F(RenderedStreamTest, AStillSceneIsRefinedToItsFinalPicture) {
  StreamClient client(server_->port(), make_session({{"scene", "cornell"}}));
  client.hello({{"width", 96}, {"height", 64}});
  const auto final_frame = client.frame_where([](const protocol::FrameHeader& frame) { return frame.is_final; }, 60s);
  ASSERT_TRUE(final_frame);
}

TEST_F(RenderedStreamTest, TheSameRequestGivesTheSameBytes) {
  const Answer first = post("/v1/render", render_request());
  ASSERT_EQ(first.status, 200) << first.body;
  EXPECT_GT(mean(decoded(first.body)), 10.0);
  EXPECT_EQ(post("/v1/render", render_request()).body, first.body);
  EXPECT_NE(post("/v1/render", render_request({{"settings", {{"seed", 1}}}})).body, first.body);
}

TEST_F(RenderedStreamTest, ViewsAndEditsShow) {
  const Image all = decoded(post("/v1/render", render_request()).body);
  const Image direct = decoded(post("/v1/render", render_request({{"settings", {{"view", "direct"}}}})).body);
  EXPECT_GT(mean_difference(all, direct), 1.0);
  const json lights = json::parse(ask(server_->port(), "GET", "/v1/scenes/cornell").body);
  const json edit{{"op", "replace"}, {"path", "/extensions/KHR_lights_punctual/lights/0/intensity"}, {"value", 0.0}};
  const json fixed{{"settings", {{"exposure_ev", 0}}}};
  json dark = fixed;
  dark["edits"] = {edit};
  const double before = mean(decoded(post("/v1/render", render_request(fixed)).body));
  const Answer after = post("/v1/render", render_request(dark));
  ASSERT_EQ(after.status, 200) << after.body;
  EXPECT_LT(mean(decoded(after.body)), before);
}

TEST_F(RenderedStreamTest, BouncesMayBeWithoutALimitForReference) {
  const auto rendered = [](const char* method, const json& bounces) {
    return post("/v1/render",
                render_request({{"settings", {{"method", method}, {"bounces", bounces}, {"exposure_ev", 0}}}}));
  };
  const Answer none = rendered("reference", 0), endless = rendered("reference", "inf");
  ASSERT_EQ(none.status, 200) << none.body;
  ASSERT_EQ(endless.status, 200) << endless.body;
  EXPECT_GT(mean(decoded(endless.body)), mean(decoded(none.body)));
  for (const Answer& refused : {rendered("thesis", "inf"), rendered("reference", 65), rendered("reference", 1 << 20)}) {
    EXPECT_EQ(refused.status, 422);
    EXPECT_EQ(json::parse(refused.body)["pointer"], "/settings/bounces") << refused.body;
  }
  const json session{{"scene", "cornell"}, {"settings", {{"method", "reference"}, {"bounces", "inf"}}}};
  const Answer made = post("/v1/sessions", session);
  ASSERT_EQ(made.status, 201) << made.body;
  EXPECT_EQ(json::parse(made.body)["settings"]["bounces"], "inf") << made.body;
}

TEST_F(RenderedStreamTest, AnUploadIsRendered) {
  ASSERT_EQ(ask(server_->port(), "PUT", "/v1/scenes/triangle", triangle_glb(), "model/gltf-binary").status, 201);
  const Answer answer = post("/v1/render", render_request({{"scene", "triangle"}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_GT(mean(decoded(answer.body)), 10.0);
}

TEST_F(RenderedStreamTest, SessionsOfDifferentScenesDoNotMix) {
  StreamClient first(server_->port(), make_session({{"scene", "cornell"}}));
  StreamClient second(server_->port(), make_session({{"scene", "helicopters"}}));
  first.hello({{"width", 96}, {"height", 64}});
  second.hello({{"width", 96}, {"height", 64}});
  ASSERT_TRUE(second.frame_where([](const protocol::FrameHeader& frame) { return frame.frame >= 3; }, 60s));
  EXPECT_TRUE(first.frame_where([](const protocol::FrameHeader& frame) { return frame.frame >= 3; }, 60s));
}

}  // namespace
}  // namespace lightwell::test
