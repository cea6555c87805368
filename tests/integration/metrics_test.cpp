// What the server tells of itself, and that the dashboard asks for nothing else.
#include <fstream>
#include <regex>
#include <set>

#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using MetricsTest = ServerTest;

TEST_F(MetricsTest, CountsWhatHappens) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  ASSERT_TRUE(client.frame_where([](const protocol::FrameHeader& frame) { return frame.is_final; }));
  const json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"settings", {{"warm_up", 0}}}};
  EXPECT_EQ(ask("POST", "/v1/render", request).status, 200);
  ask("GET", "/v1/scenes/nothing");
  ask("GET", "/nothing");
  const Answer answer = ask("GET", "/metrics");
  ASSERT_EQ(answer.status, 200);
  EXPECT_EQ(answer.field("Content-Type"), "text/plain; version=0.0.4; charset=utf-8");
  for (const char* line :
       {"lightwell_frames_total{for=\"request\"} 1\n", "lightwell_frames_total{for=\"stream\"} 64\n",
        "lightwell_device_memory_bytes 3000\n", "lightwell_device_memory_used_bytes 2000\n",
        "lightwell_device_memory_own_bytes 1000\n", "lightwell_sessions 1\n", "lightwell_viewers 1\n",
        "lightwell_ready 1\n", "lightwell_stage_seconds_count{stage=\"trace\"} 65\n",
        "lightwell_requests_total{method=\"GET\",route=\"/v1/scenes/{name}\",status=\"404\"} 1\n",
        "lightwell_requests_total{method=\"none\",route=\"none\",status=\"404\"} 1\n"})
    EXPECT_NE(answer.body.find(line), std::string::npos) << line << answer.body;
}

TEST_F(MetricsTest, TheDashboardAsksForNothingElse) {
  StreamClient client(server_.port(), make_session());
  client.hello();
  ASSERT_TRUE(client.next_frame());
  studio_->failing = true;
  ask("POST", "/v1/render", {{"scene", "cornell"}, {"width", 8}, {"height", 8}});
  const std::string metrics = ask("GET", "/metrics").body + ask("GET", "/metrics").body;
  std::ifstream file(LIGHTWELL_DASHBOARD);
  const json dashboard = json::parse(file);
  std::set<std::string> names;
  const auto collect = [&](const auto& self, const json& value) -> void {
    if (value.is_object() && value.contains("expr")) {
      const std::string expression = value["expr"];
      const std::regex name("(lightwell|process)_[a-z_]+");
      for (std::sregex_iterator it(expression.begin(), expression.end(), name), end; it != end; ++it)
        names.insert(it->str());
    }
    if (value.is_structured())
      for (const auto& member : value) self(self, member);
  };
  collect(collect, dashboard);
  EXPECT_GT(names.size(), 10u);
  for (const std::string& name : names) EXPECT_NE(metrics.find("\n" + name), std::string::npos) << name;
}

}  // namespace
}  // namespace lightwell::test
