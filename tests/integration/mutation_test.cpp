// Ten thousand random mutations of good requests: none makes the server fail, and the next good request is answered.
#include <random>

#include "tests/integration/data_folder.h"
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

constexpr int kMutations = 10'000;

struct GoodRequest {
  std::string head;  // without Content-Length and the empty line
  std::string body;

  std::string text() const {
    const std::string length = body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n";
    return head + length + "\r\n" + body;
  }
};

GoodRequest good(const std::string& method, const std::string& path, const std::string& body = {},
                 const std::string& fields = "Content-Type: application/json\r\n") {
  return {method + " " + path + " HTTP/1.1\r\nHost: localhost\r\n" + fields, body};
}

std::vector<GoodRequest> good_requests(const std::string& session) {
  const std::string path = "/v1/sessions/" + session;
  const json edit{{"op", "replace"}, {"path", "/nodes/0/translation"}, {"value", {1, 2, 3}}};
  const json keys{{"path", "/nodes/0/translation"}, {"times_s", {0, 1}}, {"values", {{0, 0, 0}, {1, 2, 3}}}};
  const json small{{"scene", "cornell"}, {"width", 8}, {"height", 8}};
  json render = small, sequence = small;
  render.update({{"edits", {edit}}, {"settings", {{"samples", 4}, {"exposure_ev", nullptr}}}, {"spp_frames", 2}});
  sequence.update({{"keyframes", {keys}}, {"last_frame", 1}, {"views", {"final"}}});
  return {good("GET", "/v1/scenes"),
          good("GET", "/v1/scenes/cornell"),
          good("POST", "/v1/render", render.dump()),
          good("POST", "/v1/sessions", small.dump()),
          good("PATCH", path, json{{"edits", {edit}}, {"playing", false}, {"time_s", 1.5}}.dump()),
          good("GET", path + "/frame?format=png&width=8&view=albedo"),
          good("PUT", "/v1/scenes/mine", triangle_glb(), "Content-Type: model/gltf-binary\r\n"),
          good("POST", "/v1/sequences", sequence.dump()),
          good("GET", "/", {}, "If-None-Match: \"1\"\r\nAccept: */*\r\n"),
          good("GET", path + "/stream", {},
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: lightwell.v1\r\n")};
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string mutated(GoodRequest request) {
    if (chance(2)) {  // the body alone, its length told truly: what is behind the framing gets its share
      mutate(request.body);
      return request.text();
    }
    std::string text = request.text();
    mutate(text);
    return text;
  }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }

 private:
  bool chance(std::size_t one_in) { return below(one_in) == 0; }

  void mutate(std::string& text) {
    for (std::size_t times = 1 + below(4); times > 0 && !text.empty(); --times) {
      const std::size_t at = below(text.size()), count = 1 + below(std::min<std::size_t>(text.size() - at, 20));
      constexpr std::string_view kTelling = "{}[]\":,-.0123456789eE\\/ \r\n\t%~";
      switch (below(6)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text[at] = kTelling[below(kTelling.size())];
          break;
        case 2:
          text.erase(at, count);
          break;
        case 3:
          text.insert(at, text.substr(at, count));
          break;
        case 4:
          text.insert(at, count, kTelling[below(kTelling.size())]);
          break;
        default:
          text.resize(at);
      }
    }
  }

  std::mt19937 random_;
};

TEST(Mutations, NoneMakesTheServerFail) {
  const DataFolder folder;
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  options.access.requests_per_second = 0;
  options.limits.max_sessions = 100'000;
  options.limits.max_viewers_per_session = 100'000;
  options.limits.max_size_px = 64;
  options.limits.max_sequence_frames = 10;
  const auto studio = std::make_shared<FakeStudio>();
  studio->render_ms = 0;
  RunningServer server(options, fake_source(studio));
  wait_until_ready(server);
  const std::string session = json::parse(
      ask(server.port(), "POST", "/v1/sessions", R"({"scene":"cornell","width":8,"height":8,"playing":false})")
          .body)["id"];
  const std::vector<GoodRequest> requests = good_requests(session);
  Mutator mutator(1);
  std::map<int, int> statuses;
  for (int i = 0; i < kMutations; ++i) {
    const std::string text = mutator.mutated(requests[mutator.below(requests.size())]);
    Line line(server.port());
    line.send(text);
    line.shut_down_sending();
    const int status = read_answer(line, true).status;
    ++statuses[status];
    // 501 and 505 are what RFC 9110 has for a Transfer-Encoding and a version that nobody knows.
    ASSERT_TRUE(status < 500 || status == 501 || status == 505) << status << " to mutation " << i << ":\n" << text;
  }
  EXPECT_EQ(ask(server.port(), "GET", "/v1/sessions/" + session).status, 200);
  EXPECT_EQ(ask(server.port(), "POST", "/v1/render", R"({"scene":"cornell","width":8,"height":8})").status, 200);
  for (const int wanted : {101, 200, 400, 404, 422}) EXPECT_GT(statuses[wanted], 50) << wanted;
}

}  // namespace
}  // namespace lightwell::test
