// Every refusal that the OpenAPI document shows is one that the server gives, in those words.
#include <regex>

#include "protocol/openapi_document.h"
#include "server/video/video_encoder.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/glb_writer.h"
#include "tests/integration/malformed_heads.h"
#include "tests/integration/server_fixture.h"
#include "tests/unit/rich_gltf.h"

namespace lightwell::test {
namespace {

using std::chrono::milliseconds;

const char* const kGlb = "model/gltf-binary";

/// A server of its own for a few questions.
class Asked {
 public:
  explicit Asked(ServeOptions options = test_options(), MakePictureSource source = nullptr)
      : studio(std::make_shared<FakeStudio>()), server(options, source ? std::move(source) : fake_source(studio)) {}

  Asked& until_ready() {
    server.ready().wait();
    while (ask("GET", "/v1/scenes").status == 503) std::this_thread::sleep_for(milliseconds(5));
    return *this;
  }
  Answer ask(const std::string& method, const std::string& target, const std::string& body = {},
             const std::string& type = "application/json", const std::string& fields = {}) const {
    return test::ask(server.port(), method, target, body, type, fields);
  }
  Answer render(const json& change) const {
    json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}};
    request.update(change);
    return ask("POST", "/v1/render", request.dump());
  }
  Answer raw(const std::string& text) const {
    Line line(server.port());
    line.send(text);
    return read_answer(line);
  }
  std::string session() const {
    return json::parse(ask("POST", "/v1/sessions", R"({"scene":"cornell","width":8,"height":8})").body)["id"];
  }
  static std::string handshake(const std::string& session) {
    return "GET /v1/sessions/" + session +
           "/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
           "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  }

  std::shared_ptr<FakeStudio> studio;
  RunningServer server;
};

using Answers = std::map<std::string, Answer>;  // by the example's name

void ask_what_is_malformed(Answers& answers) {
  Asked asked;
  asked.until_ready();
  answers["not_json"] = asked.ask("POST", "/v1/render", "{\"scene\":cornell}");
  answers["member_twice"] = asked.ask("POST", "/v1/render", R"({"scene":"cornell","settings":{"seed":1,"seed":2}})");
  answers["too_deep"] = asked.ask("POST", "/v1/render", R"({"scene":"cornell","edits":)" + std::string(40, '['));
  answers["length"] =
      asked.raw("POST /v1/render HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n\r\n");
  answers["body"] = asked.ask("POST", "/v1/render", std::string(2'000'000, ' '));
  std::string values = R"({"scene":"cornell","edits":[{"op":"add","path":"/nodes/0/weights","value":[0)";
  for (int i = 0; i < 200'000; ++i) values += ",0";
  answers["values"] = asked.ask("POST", "/v1/render", values + "]}]}");
  answers["no_body"] = asked.ask("GET", "/v1/scenes", "body");
  answers["type"] = asked.ask("POST", "/v1/render", "{}", "text/plain");
  answers["encoded"] = asked.ask("POST", "/v1/render", "{}", "application/json", "Content-Encoding: gzip\r\n");
  answers["method"] = asked.ask("POST", "/v1/scenes", "{}");
  answers["target"] = asked.ask("GET", "/" + std::string(5000, 'x'));
  answers["expectation"] = asked.ask("GET", "/", {}, {}, "Expect: a-miracle\r\n");
  std::string fields;
  for (int i = 0; i < 100; ++i) fields += "X-" + std::to_string(i) + ": 1\r\n";
  answers["fields"] = asked.ask("GET", "/", {}, {}, fields);
  answers["encoding"] = asked.raw("POST /v1/render HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: gzip\r\n\r\n");
  answers["version"] = asked.raw("GET / HTTP/2.0\r\nHost: localhost\r\n\r\n");
  answers["misdirected"] = asked.raw("GET / HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n");
  answers["forbidden"] =
      asked.ask("POST", "/v1/sessions", "{}", "application/json", "Origin: https://elsewhere.example\r\n");
  answers["timeout"] = asked.raw("GET / HT");
  for (const MalformedHead& head : malformed_heads("/v1/sessions/" + asked.session() + "/stream"))
    answers[head.name] = asked.raw(head.request);
}

void ask_what_means_nothing(Answers& answers) {
  Asked asked;
  asked.until_ready();
  answers["wrong_type"] = asked.render({{"width", "512"}});
  answers["unknown_member"] = asked.render({{"settings", {{"sample", 1}}}});
  answers["missing_member"] = asked.ask("POST", "/v1/render", "{}");
  const json edit{{"op", "replace"}, {"path", "/nodes/99/translation"}, {"value", {0, 0, 0}}};
  answers["edit"] = asked.render({{"edits", {edit}}});
  answers["scene_file"] = asked.ask("PUT", "/v1/scenes/mine", triangle_glb().substr(0, 200), kGlb);
  answers["scene_name"] = asked.ask("PUT", "/v1/scenes/My%20Room", triangle_glb(), kGlb);
  answers["no_such_scene"] = asked.render({{"scene", "atrum"}});
  answers["size"] = asked.render({{"width", 9000}});
  answers["samples"] = asked.render({{"settings", {{"samples", 5000}}}});
  answers["scene"] = asked.ask("GET", "/v1/scenes/atrum");
  answers["session"] = asked.ask("GET", "/v1/sessions/3f9a0c51d2e84b76");
  answers["path"] = asked.ask("GET", "/v2/render");
  answers["builtin"] = asked.ask("PUT", "/v1/scenes/cornell", triangle_glb(), kGlb);
  for (const char* name : {"a", "b", "c"}) asked.ask("PUT", std::string("/v1/scenes/") + name, triangle_glb(), kGlb);
  answers["too_many"] = asked.ask("PUT", "/v1/scenes/d", triangle_glb(), kGlb);
  asked.studio->throwing = true;
  answers["internal"] = asked.render(json::object());
  answers["idle"] = asked.ask("POST", "/v1/sessions", R"({"scene":"cornell","width":8,"height":8,"idle_s":86400})");
  answers["upgrade"] = asked.ask("GET", "/v1/sessions/" + asked.session() + "/stream");
}

/// Films that cannot go on, for all who would make them wait for pictures, until there is one too many.
Answer ask_for_many_films(Asked& asked, const std::string& target) {
  const auto get = [&](Line& line) {
    line.send("GET " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    return read_answer(line, true);
  };
  asked.studio->held = true;
  std::vector<std::unique_ptr<Line>> renders, films;
  for (int i = 0; i < 8; ++i) {
    renders.push_back(std::make_unique<Line>(asked.server.port()));
    renders.back()->send(post_text("/v1/render", R"({"scene":"cornell","width":8,"height":8})"));
  }
  EXPECT_TRUE(comes_true(
      [&] { return asked.ask("GET", "/metrics").body.find("\nlightwell_renders_waiting 8\n") != std::string::npos; }));
  for (int i = 0; i < 4; ++i) {
    films.push_back(std::make_unique<Line>(asked.server.port()));
    EXPECT_EQ(get(*films.back()).status, 200);
  }
  Answer answer = asked.ask("GET", target);
  asked.studio->held = false;
  return answer;
}

void ask_another_server(Answers& answers) {
  const DataFolder folder;
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  Asked first(options), second(options);
  const std::string session = first.until_ready().session();
  answers["elsewhere"] = second.until_ready().ask("GET", "/v1/sessions/" + session);
  EXPECT_TRUE(first.server.drain(test::kPatience));
  answers["just_came"] = second.raw(Asked::handshake(session));
}

void ask_for_sequences(Answers& answers) {
  answers["no_folder"] = Asked().until_ready().ask("GET", "/v1/sequences");
  const DataFolder folder;
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  options.limits.max_sequence_frames = 100;
  options.limits.max_sequence_bytes = 1;
  Asked asked(options);
  asked.until_ready();
  const auto submit = [&](const json& change) {
    json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"last_frame", 0}};
    request.update(change);
    return asked.ask("POST", "/v1/sequences", request.dump());
  };
  const std::string done = "/v1/sequences/" + json::parse(submit(json::object()).body)["id"].get<std::string>();
  while (asked.ask("GET", done + "/archive").status != 200) std::this_thread::sleep_for(milliseconds(10));
  answers["view"] = asked.ask("GET", done + "/frames/0?view=depth");
  answers["frame"] = asked.ask("GET", done + "/frames/120");
  answers["sequence"] = asked.ask("GET", "/v1/sequences/x");
  answers["disk"] = submit({{"fps", 25}});
  answers["too_many_frames"] = submit({{"last_frame", 20000}});
  answers["keyframes"] = submit({{"keyframes", {{{"path", "/x"}, {"times_s", {1, 1}}, {"values", {1, 2}}}}}});
  asked.ask("DELETE", done);
  asked.studio->held = true;
  const std::string slow = "/v1/sequences/" + json::parse(submit({{"last_frame", 9}}).body)["id"].get<std::string>();
  answers["not_finished"] = asked.ask("GET", slow + "/frames/9");
  answers["not_done"] = asked.ask("GET", slow + "/archive");
  asked.ask("DELETE", slow);
  asked.studio->held = false;
}

void ask_for_films(Answers& answers) {
  const DataFolder folder;
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  Asked asked(options);
  asked.until_ready();
  const auto film_of = [&](const json& change) {
    json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"last_frame", 0}};
    request.update(change);
    const Answer answer = asked.ask("POST", "/v1/sequences", request.dump());
    return "/v1/sequences/" + json::parse(answer.body).value("id", "") + "/video";
  };
  answers["film_of_exr"] = asked.ask("GET", film_of({{"format", "exr"}}));
  answers["film_size"] = asked.ask("GET", film_of({{"width", 9}}));
  const std::string film = film_of(json::object());
  EXPECT_TRUE(comes_true([&] { return asked.ask("HEAD", film).status != 409; }));
  if (can_encode_video()) answers["films"] = ask_for_many_films(asked, film);
  options.video = false;
  answers["no_encoder"] = Asked(options).until_ready().ask("GET", film);
}

void ask_for_too_much(Answers& answers) {
  ServeOptions options = test_options();
  options.limits.max_triangles = 1;
  options.limits.max_scene_bytes = 700;
  options.limits.max_viewers_per_session = 1;
  Asked asked(options);
  asked.until_ready();
  answers["triangles"] = asked.ask("PUT", "/v1/scenes/two", triangle_glb(2), kGlb);
  asked.ask("PUT", "/v1/scenes/one", triangle_glb(), kGlb);
  answers["scene_bytes"] = asked.ask("PUT", "/v1/scenes/more", triangle_glb(), kGlb);
  const std::string session = asked.session();
  Line first(asked.server.port());
  first.send(Asked::handshake(session));
  first.receive_until("\r\n\r\n");
  answers["viewers"] = asked.raw(Asked::handshake(session));
  for (int i = 1; i < options.limits.max_sessions; ++i) asked.session();
  answers["sessions"] = asked.ask("POST", "/v1/sessions", R"({"scene":"cornell"})");
}

void ask_for_large_textures(Answers& answers) {
  ServeOptions options = test_options();
  options.limits.max_texture_bytes = 3;  // less than a pixel
  Asked asked(options);
  asked.until_ready();
  const ByteVector glb = rich_gltf().glb();
  const std::string bytes(reinterpret_cast<const char*>(glb.data()), glb.size());
  answers["textures"] = asked.ask("PUT", "/v1/scenes/textured", bytes, kGlb);
}

void ask_too_often(Answers& answers) {
  ServeOptions options = test_options();
  options.access.requests_per_second = 1e-3;
  options.access.request_burst = 1;
  Asked asked(options);
  asked.ask("GET", "/");
  answers["rate"] = asked.ask("GET", "/");
}

void ask_without_leave(Answers& answers) {
  ServeOptions options = test_options();
  ASSERT_TRUE(options.access.tokens.add("view-token-0123456789", Scope::kView));
  Asked asked(options);
  asked.until_ready();
  answers["unauthorized"] = asked.ask("GET", "/v1/scenes");
  answers["unknown_token"] = asked.ask("GET", "/v1/scenes", {}, {}, "Authorization: Bearer guess\r\n");
  answers["scope"] =
      asked.ask("POST", "/v1/sessions", "{}", "application/json", "Authorization: Bearer view-token-0123456789\r\n");
}

void ask_at_the_wrong_time(Answers& answers) {
  std::promise<void> start;
  const auto started = start.get_future().share();
  const auto studio = std::make_shared<FakeStudio>();
  const auto late_source = [started, studio]() -> std::unique_ptr<PictureSource> {
    started.wait();
    return std::make_unique<FakeSource>(studio);
  };
  comes_true([&] {  // a server that has just been started; seldom it is so quick that another is needed
    answers["loading"] = Asked().ask("GET", "/v1/scenes");
    return answers["loading"].status == 503;
  });
  Asked asked(test_options(), late_source);
  while (asked.ask("GET", "/v1/scenes").status == 503) std::this_thread::sleep_for(milliseconds(5));
  answers["starting"] = asked.render(json::object());
  start.set_value();
  asked.server.ready().wait();

  studio->render_ms = 50;
  const std::string body = R"({"scene":"cornell","width":8,"height":8,"spp_frames":1000})";
  std::vector<Line> lines;
  for (int i = 0; i < 80; ++i) lines.emplace_back(asked.server.port()).send(post_text("/v1/render", body));
  // More than can wait: some are refused, whichever of them came last.
  comes_true([&] {
    return std::any_of(lines.begin(), lines.end(), [&](Line& line) {
      return (answers["busy"] = read_answer(line, false, milliseconds(2))).status != 0;
    });
  });
  // What was begun takes minutes: until the drain is over, or has given up, late comers are told.
  std::thread drainer([&] { asked.server.drain(test::kPatience / 2); });
  while (asked.ask("GET", "/readyz").status != 503) std::this_thread::sleep_for(milliseconds(5));
  comes_true([&] { return (answers["stopping"] = asked.ask("GET", "/v1/scenes")).status == 503; });
  lines.clear();
  drainer.join();
}

/// With every number and every quoted word replaced: what may differ from case to case.
std::string shape_of(const std::string& detail) {
  const std::string words = std::regex_replace(detail, std::regex("\"[^\"]*\""), "\"...\"");
  return std::regex_replace(words, std::regex("[0-9]+"), "N");
}

/// All examples of problems in the document, by their names.
std::map<std::string, json> documented() {
  std::map<std::string, json> examples;
  const auto collect = [&](const auto& self, const json& value) -> void {
    if (!value.is_structured()) return;
    if (value.is_object() && value.contains("application/problem+json")) {
      for (const auto& [name, example] : value["application/problem+json"]["examples"].items())
        EXPECT_TRUE(examples.emplace(name, example["value"]).second) << name << " twice";
    }
    for (const auto& member : value) self(self, member);
  };
  collect(collect, json::parse(protocol::openapi_document()));
  return examples;
}

TEST(Refusals, AreThoseOfTheDocument) {
  Answers answers;
  for (const auto& ask_for :
       {ask_what_is_malformed, ask_what_means_nothing, ask_another_server, ask_for_sequences, ask_for_films,
        ask_for_too_much, ask_for_large_textures, ask_too_often, ask_without_leave, ask_at_the_wrong_time})
    ask_for(answers);
  auto examples = documented();
  if (!can_encode_video()) {  // a build without an encoder makes no films of which there could be too many
    EXPECT_EQ(examples.erase("films"), 1u);
  }
  for (const auto& [name, example] : examples) {
    ASSERT_TRUE(answers.contains(name)) << name << " is shown, and not asked for";
    ASSERT_NE(answers[name].status, 0) << name << " was not answered";
    const json given = problem(answers[name]);
    EXPECT_EQ(given["status"], example["status"]) << name;
    EXPECT_EQ(given["title"], example["title"]) << name;
    EXPECT_EQ(shape_of(given.value("detail", "")), shape_of(example["detail"])) << name;
    EXPECT_EQ(given.contains("pointer"), example.contains("pointer")) << name << given;
    const int status = example["status"];
    if (status == 429 || status == 503) {
      EXPECT_FALSE(answers[name].field("Retry-After").empty()) << name;
    }
    if (status == 401) {
      EXPECT_FALSE(answers[name].field("WWW-Authenticate").empty()) << name;
    }
  }
  for (const auto& [name, answer] : answers)
    EXPECT_TRUE(examples.contains(name)) << name << " is not in the document: " << answer.body;
}

}  // namespace
}  // namespace lightwell::test
