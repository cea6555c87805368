// Every refusal that the OpenAPI document shows is one that the server gives, in those words.
#include <cstdlib>

#include "server/data/database.h"
#include "server/video/video_encoder.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/glb_writer.h"
#include "tests/integration/malformed_heads.h"
#include "tests/integration/refusals_fixture.h"
#include "tests/unit/rich_gltf.h"

namespace lightwell::test {
namespace {

using std::chrono::milliseconds;

const char* const kGlb = "model/gltf-binary";

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
  Line half_a_body(asked.server.port());
  half_a_body.send(post_text("/v1/render", "{}").substr(0, post_text("/v1/render", "{}").size() - 1));
  answers["timeout"] = asked.raw("GET / HT");
  answers["body_timeout"] = read_answer(half_a_body);
  const std::string chunked =
      "POST /v1/render HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: "
      "chunked\r\n\r\n";
  answers["chunk_line"] = asked.raw(chunked + "1;" + std::string(300, 'x'));
  answers["chunk_line_end"] = asked.raw(chunked + "1\n{");
  answers["chunk_longer"] = asked.raw(chunked + "1\r\n{}\r\n");
  std::string trailer;
  for (int i = 0; i < 100; ++i) trailer += "X-Field-" + std::to_string(i) + ": " + std::string(200, 'x') + "\r\n";
  answers["trailer"] = asked.raw(chunked + "2\r\n{}\r\n0\r\n" + trailer + "\r\n");
  for (const MalformedHead& head : malformed_heads("/v1/sessions/" + asked.session() + "/stream"))
    answers[head.name] = asked.raw(head.request);
}

/// In plain words, of a server that speaks TLS; and where a base path was left out.
void ask_at_the_wrong_place(Answers& answers) {
  const DataFolder folder;
  std::filesystem::create_directories(folder.path());
  ServeOptions options = test_options();
  options.tls_key = (folder.path() / "key.pem").string();
  options.tls_certificate = (folder.path() / "certificate.pem").string();
  const std::string make = "openssl req -x509 -newkey rsa:2048 -nodes -subj /CN=localhost -keyout " + options.tls_key +
                           " -out " + options.tls_certificate + " 2> /dev/null";
  ASSERT_EQ(std::system(make.c_str()), 0);
  answers["tls"] = Asked(options).ask("GET", "/");
  options = test_options();
  options.base_path = "/lightwell";
  answers["moved"] = Asked(options).ask("GET", "/lightwell");
}

void ask_beside_many(Answers& answers) {
  {
    Asked asked;
    asked.until_ready();
    std::vector<std::unique_ptr<Line>> uploads;  // none is whole: together they are what the server holds at most
    const std::string head = "PUT /v1/scenes/s HTTP/1.1\r\nHost: localhost\r\nContent-Type: " + std::string(kGlb) +
                             "\r\nContent-Length: 4194304\r\n\r\n";
    const std::string most(4'194'303, 'x');
    EXPECT_TRUE(comes_true([&] {
      uploads.push_back(std::make_unique<Line>(asked.server.port()));
      uploads.back()->send(head + most);
      return (answers["bodies"] = read_answer(*uploads.back(), false, milliseconds(200))).status != 0;
    }));
  }
  ServeOptions options = test_options();
  options.limits.max_connections = 1;
  Asked asked(options);
  Line first(asked.server.port());
  first.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(read_answer(first).status, 200);
  answers["connections"] = asked.raw({});
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
  answers["page"] = asked.ask("POST", "/", "{}");
  answers["type_of_file"] = asked.ask("PUT", "/v1/scenes/mine", triangle_glb(), "text/plain");
  answers["builtin"] = asked.ask("PUT", "/v1/scenes/cornell", triangle_glb(), kGlb);
  for (const char* name : {"a", "b", "c"}) asked.ask("PUT", std::string("/v1/scenes/") + name, triangle_glb(), kGlb);
  answers["too_many"] = asked.ask("PUT", "/v1/scenes/d", triangle_glb(), kGlb);
  asked.studio->throwing = true;
  answers["internal"] = asked.render(json::object());
  answers["idle"] = asked.ask("POST", "/v1/sessions", R"({"scene":"cornell","width":8,"height":8,"idle_s":86400})");
  answers["upgrade"] = asked.ask("GET", "/v1/sessions/" + asked.session() + "/stream");
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

void ask_for_too_much(Answers& answers) {
  ServeOptions options = test_options();
  options.limits.max_triangles = 1;
  options.limits.max_scene_bytes = 700;
  options.limits.max_spp_frames = 16;
  options.limits.max_viewers_per_session = 1;
  Asked asked(options);
  asked.until_ready();
  answers["spp_frames"] = asked.render({{"spp_frames", 17}});
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

TEST(Refusals, AreThoseOfTheDocument) {
  Answers answers;
  for (const auto& ask_for :
       {ask_what_is_malformed, ask_at_the_wrong_place, ask_for_what_is_gone, ask_beside_many, ask_what_means_nothing,
        ask_another_server, ask_for_sequences, ask_for_films, ask_for_too_much, ask_for_large_textures, ask_too_often,
        ask_without_leave, ask_at_the_wrong_time})
    ask_for(answers);
  auto examples = documented();
  if (!can_encode_video()) {  // a build without an encoder makes no films of which there could be too many
    EXPECT_EQ(examples.erase("films"), 1u);
  }
  std::erase_if(examples, [](const auto& example) { return example.second.contains("x-asked"); });
  for (const auto& [name, whole] : examples) {
    const json& example = whole["value"];
    ASSERT_TRUE(answers.contains(name)) << name << " is shown, and not asked for";
    ASSERT_NE(answers[name].status, 0) << name << " was not answered";
    expect_problem(name, problem(answers[name]), example);
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

/// What the document says was asked is asked.
TEST(Refusals, OfValuesAreWhatTheDocumentSays) {
  const DataFolder folder;
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  Asked asked(options);
  asked.until_ready();
  const std::string session = asked.session();
  const std::string body = R"({"scene":"cornell","width":8,"height":8,"last_frame":0})";
  const std::string sequence = json::parse(asked.ask("POST", "/v1/sequences", body).body)["id"];
  EXPECT_TRUE(comes_true([&] { return asked.ask("GET", "/v1/sequences/" + sequence + "/archive").status == 200; }));
  int asked_for = 0;
  for (const auto& [name, example] : documented()) {
    if (!example.contains("x-asked")) continue;
    const json& question = example["x-asked"];
    const std::string operation = question["operation"];
    const auto space = operation.find(' ');
    std::string target = operation.substr(space + 1);
    for (const auto& [hole, id] : {std::pair<std::string, std::string>("{id}", session), {"{sequence}", sequence}})
      if (const auto at = target.find(hole); at != std::string::npos) target.replace(at, hole.size(), id);
    const Answer answer = asked.ask(operation.substr(0, space), target,
                                    question.contains("body") ? question["body"].dump() : std::string());
    const json given = problem(answer);
    expect_problem(name, given, example["value"]);
    EXPECT_EQ(given.value("pointer", ""), example["value"].value("pointer", "")) << name;
    ++asked_for;
  }
  EXPECT_GT(asked_for, 30);
}

}  // namespace
}  // namespace lightwell::test
