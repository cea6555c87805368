// Every route of the HTTP side, with what is good and what is bad; POST /v1/render is in renderings_test.cpp.
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

using ApiTest = ServerTest;

const char* const kGlb = "model/gltf-binary";

TEST_F(ApiTest, TellsItsHealth) {
  EXPECT_EQ(ask("GET", "/healthz").body, R"({"status":"ok"})");
  EXPECT_EQ(ask("GET", "/readyz").status, 200);
}

TEST_F(ApiTest, EveryAnswerHasTheSecurityFields) {
  for (const char* target : {"/healthz", "/nothing", "/v1/scenes"}) {
    const Answer answer = ask("GET", target);
    EXPECT_EQ(answer.field("X-Content-Type-Options"), "nosniff") << target;
    EXPECT_FALSE(answer.field("Date").empty()) << target;
  }
}

TEST_F(ApiTest, AnswersHeadWithoutABody) {
  Line line(server_.port());
  line.send("HEAD /v1/scenes HTTP/1.1\r\nHost: localhost\r\n\r\nHEAD /nothing HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const Answer scenes = read_answer(line, true);
  EXPECT_EQ(scenes.status, 200);
  EXPECT_EQ(scenes.field("Content-Length"), std::to_string(ask("GET", "/v1/scenes").body.size()));
  EXPECT_EQ(read_answer(line, true).status, 404);
}

TEST_F(ApiTest, RefusesWhatIsNotThereAndWhatIsNotAllowed) {
  EXPECT_EQ(problem(ask("GET", "/nothing"))["status"], 404);
  EXPECT_EQ(problem(ask("GET", "/v1/scenes/cornell/more"))["status"], 404);
  EXPECT_EQ(problem(ask("GET", "/../etc/passwd"))["status"], 404);
  EXPECT_EQ(problem(ask("GET", "/%2e%2e/etc/passwd"))["status"], 404);
  const Answer wrong_method = ask("DELETE", "/v1/scenes");
  EXPECT_EQ(problem(wrong_method)["status"], 405);
  EXPECT_EQ(wrong_method.field("Allow"), "GET, HEAD");
  EXPECT_EQ(problem(ask("BREW", "/v1/scenes"))["status"], 405);
  EXPECT_EQ(problem(ask("POST", "/v1/render", "{}", "text/plain"))["status"], 415);
  EXPECT_EQ(problem(ask("GET", "/healthz", "body"))["status"], 413);
  EXPECT_EQ(problem(ask("POST", "/v1/render", std::string(2'000'000, ' ')))["status"], 413);
  Line line(server_.port());
  line.send("POST /v1/render HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n\r\n");
  EXPECT_EQ(read_answer(line).status, 411);
}

TEST_F(ApiTest, RefusesChangesThatForeignPagesAskFor) {
  const std::string body = R"({"scene":"cornell"})";
  const std::string foreign = "Origin: https://evil.example\r\n";
  EXPECT_EQ(problem(ask("POST", "/v1/sessions", body, "application/json", foreign))["status"], 403);
  EXPECT_EQ(ask("GET", "/v1/scenes", "", "", foreign).status, 200);
  const std::string own = "Origin: http://127.0.0.1:" + std::to_string(server_.port()) + "\r\n";
  EXPECT_EQ(ask("POST", "/v1/sessions", body, "application/json", own).status, 201);
}

TEST_F(ApiTest, ListsScenesTheFirstBeingTheOneItWasStartedWith) {
  const json scenes = json::parse(ask("GET", "/v1/scenes").body)["scenes"];
  ASSERT_FALSE(scenes.empty());
  EXPECT_EQ(scenes[0]["name"], "cornell");
  EXPECT_TRUE(scenes[0]["builtin"].get<bool>());
  EXPECT_GT(scenes[0]["triangles"].get<int>(), 0);
}

TEST_F(ApiTest, DescribesAScene) {
  EXPECT_TRUE(json::parse(ask("GET", "/v1/scenes/cornell").body).contains("nodes"));
  EXPECT_EQ(problem(ask("GET", "/v1/scenes/nothing"))["status"], 404);
}

TEST_F(ApiTest, TakesReplacesAndForgetsUploads) {
  const std::string glb = triangle_glb();
  const Answer created = ask("PUT", "/v1/scenes/mine", glb, kGlb);
  ASSERT_EQ(created.status, 201) << created.body;
  EXPECT_EQ(created.field("Location"), "/v1/scenes/mine");
  EXPECT_EQ(json::parse(created.body)["triangles"], 1);
  EXPECT_EQ(ask("PUT", "/v1/scenes/mine", glb, kGlb).status, 200);
  EXPECT_EQ(ask("GET", "/v1/scenes/mine").status, 200);
  const Answer gone = ask("DELETE", "/v1/scenes/mine");
  EXPECT_EQ(gone.status, 204);
  EXPECT_TRUE(gone.field("Content-Length").empty());
  EXPECT_EQ(problem(ask("DELETE", "/v1/scenes/mine"))["status"], 404);
}

TEST_F(ApiTest, BuiltInScenesStay) {
  EXPECT_EQ(problem(ask("DELETE", "/v1/scenes/cornell"))["status"], 409);
  EXPECT_EQ(problem(ask("PUT", "/v1/scenes/cornell", triangle_glb(), kGlb))["status"], 409);
}

TEST_F(ApiTest, BoundsUploads) {
  EXPECT_EQ(problem(ask("PUT", "/v1/scenes/Bad.Name", triangle_glb(), kGlb))["status"], 422);
  EXPECT_EQ(problem(ask("PUT", "/v1/scenes/mine", "{}"))["status"], 415);
  EXPECT_EQ(problem(ask("PUT", "/v1/scenes/mine", std::string(5u << 20, 'x'), kGlb))["status"], 413);
  for (const char* name : {"a", "b", "c"})
    EXPECT_EQ(ask("PUT", std::string("/v1/scenes/") + name, triangle_glb(), kGlb).status, 201);
  EXPECT_EQ(problem(ask("PUT", "/v1/scenes/d", triangle_glb(), kGlb))["status"], 409);
  EXPECT_EQ(ask("PUT", "/v1/scenes/c", triangle_glb(), kGlb).status, 200);
}

TEST_F(ApiTest, AHostileUploadLeavesNoTrace) {
  const std::string before = ask("GET", "/v1/scenes").body;
  const std::string glb = triangle_glb();
  const std::vector<std::string> hostile = {
      std::string(),
      "glTF",
      glb.substr(0, 20),
      glb.substr(0, glb.size() - 5),
      std::string(1000, '\xff'),
      "glTF" + std::string("\2\0\0\0\xff\xff\xff\xff", 8),
      glb_of_json(R"({"asset":{"version":"2.0"},"nodes":[{"children":[0]}]})"),
      glb_of_json(R"({"asset":{"version":"2.0"},"accessors":[{"count":4294967295}]})"),
      glb_of_json(std::string(100'000, '['))};
  for (const std::string& bytes : hostile) {
    const Answer answer = ask("PUT", "/v1/scenes/hostile", bytes, kGlb);
    EXPECT_GE(answer.status, 400) << bytes.substr(0, 60);
    EXPECT_LT(answer.status, 500) << answer.body;
    problem(answer);
    EXPECT_EQ(ask("GET", "/v1/scenes").body, before);
  }
  EXPECT_EQ(ask("PUT", "/v1/scenes/good", glb, kGlb).status, 201);
}

TEST_F(ApiTest, KeepsSessions) {
  const Answer created =
      ask("POST", "/v1/sessions", {{"scene", "cornell"}, {"width", 100}, {"height", 50}, {"playing", false}});
  ASSERT_EQ(created.status, 201) << created.body;
  const json session = json::parse(created.body);
  const std::string path = "/v1/sessions/" + session["id"].get<std::string>();
  EXPECT_EQ(created.field("Location"), path);
  EXPECT_EQ(session["revision"], 1);
  EXPECT_EQ(session["viewers"], 0);
  EXPECT_EQ(session["settings"]["method"], "realtime");

  const Answer changed = ask("PATCH", path, {{"settings", {{"samples", 7}}}, {"time_s", 2.5}, {"width", 64}});
  ASSERT_EQ(changed.status, 200) << changed.body;
  const json after = json::parse(ask("GET", path).body);
  EXPECT_EQ(after, json::parse(changed.body));
  EXPECT_EQ(after["settings"]["samples"], 7);
  EXPECT_EQ(after["time_s"], 2.5);
  EXPECT_EQ(after["width"], 64);
  EXPECT_EQ(after["revision"], 2);

  EXPECT_EQ(ask("DELETE", path).status, 204);
  EXPECT_EQ(problem(ask("GET", path))["status"], 404);
  EXPECT_EQ(problem(ask("DELETE", path))["status"], 404);
  EXPECT_EQ(problem(ask("PATCH", path, "{}"))["status"], 404);
}

TEST_F(ApiTest, APatchIsAllOrNothing) {
  const std::string path = "/v1/sessions/" + make_session({{"playing", false}});
  const std::string before = ask("GET", path).body;
  const json good_edit{{"op", "replace"}, {"path", "/nodes/0/translation"}, {"value", {1, 2, 3}}};
  const json bad_edit{{"op", "replace"}, {"path", "/nodes/0/nonsense"}, {"value", 1}};
  const Answer answer = ask("PATCH", path, {{"settings", {{"samples", 3}}}, {"edits", {good_edit, bad_edit}}});
  EXPECT_EQ(problem(answer).value("pointer", ""), "/edits/1");
  EXPECT_EQ(ask("GET", path).body, before);
  EXPECT_EQ(ask("PATCH", path, {{"edits", {good_edit}}}).status, 200);
  EXPECT_EQ(problem(ask("PATCH", path, {{"camera", {{"index", 50}}}, {"time_s", 9}}))["pointer"], "/camera/index");
  EXPECT_EQ(json::parse(ask("GET", path).body)["time_s"], 0.0);
}

TEST_F(ApiTest, EditsOfOneSessionAreNotSeenByOthers) {
  const std::string mine = "/v1/sessions/" + make_session(), described = ask("GET", "/v1/scenes/cornell").body;
  const json edit{{"op", "replace"}, {"path", "/nodes/0/translation"}, {"value", {1, 2, 3}}};
  EXPECT_EQ(ask("PATCH", mine, {{"edits", {edit}}}).status, 200);
  EXPECT_EQ(ask("GET", "/v1/scenes/cornell").body, described);
}

TEST_F(ApiTest, BoundsSessions) {
  for (int i = 0; i < 8; ++i) make_session();
  const Answer answer = ask("POST", "/v1/sessions", {{"scene", "cornell"}});
  EXPECT_EQ(problem(answer)["status"], 503);
  EXPECT_FALSE(answer.field("Retry-After").empty());
}

TEST_F(ApiTest, GivesASessionsPictureAsItIsNow) {
  const std::string path = "/v1/sessions/" + make_session({{"width", 40}, {"height", 20}}) + "/frame";
  EXPECT_EQ(ask("GET", path).field("Content-Type"), "image/jpeg");
  EXPECT_EQ(ask("GET", path + "?format=png&width=10&height=10&view=albedo").field("Content-Type"), "image/png");
  EXPECT_EQ(studio_->requests().back().size_px, glm::ivec2(10, 10));
  EXPECT_EQ(studio_->requests().back().settings.view, ViewKind::kAlbedo);
  EXPECT_EQ(problem(ask("GET", path + "?view=x"))["status"], 422);
  EXPECT_EQ(problem(ask("GET", path + "?size=1"))["status"], 422);
  EXPECT_EQ(problem(ask("GET", path + "?width=99999"))["status"], 422);
  EXPECT_EQ(problem(ask("GET", "/v1/sessions/nothing/frame"))["status"], 404);
}

TEST_F(ApiTest, ServesTheViewer) {
  const Answer page = ask("GET", "/");
  ASSERT_EQ(page.status, 200);
  EXPECT_EQ(page.field("Content-Type"), "text/html; charset=utf-8");
  EXPECT_NE(page.field("Content-Security-Policy").find("script-src 'self'"), std::string::npos);
  EXPECT_EQ(ask("GET", "/protocol.js").field("Content-Type"), "text/javascript; charset=utf-8");
  const Answer again = ask("GET", "/", "", "", "If-None-Match: " + page.field("ETag") + "\r\n");
  EXPECT_EQ(again.status, 304);
  EXPECT_TRUE(again.body.empty());
}

TEST(BasePath, IsTakenOffAndPutOn) {
  ServeOptions options = test_options();
  options.base_path = "/light";
  RunningServer server(options, fake_source(std::make_shared<FakeStudio>()));
  server.ready().wait();
  EXPECT_TRUE(server.url().ends_with("/light/"));
  while (ask(server.port(), "GET", "/light/v1/scenes").status != 200)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const Answer moved = ask(server.port(), "GET", "/light");
  EXPECT_EQ(moved.status, 308);
  EXPECT_EQ(moved.field("Location"), "/light/");
  EXPECT_EQ(ask(server.port(), "GET", "/light/").status, 200);
  EXPECT_EQ(ask(server.port(), "GET", "/healthz").status, 200);  // a proxy that takes the prefix off itself
  const Answer session = ask(server.port(), "POST", "/light/v1/sessions", R"({"scene":"cornell"})");
  EXPECT_TRUE(session.field("Location").starts_with("/light/v1/sessions/"));
}

TEST(Startup, TellsASceneThatIsRefused) {
  ServeOptions options = test_options();
  options.scene = "/nothing/here.glb";
  RunningServer server(options, fake_source(std::make_shared<FakeStudio>()));
  EXPECT_THROW(server.ready().get(), SceneRefused);
}

TEST(Startup, TellsThatThereIsNoDevice) {
  RunningServer server(test_options(), []() -> std::unique_ptr<PictureSource> { throw gl::NoDevice("none"); });
  EXPECT_THROW(server.ready().get(), gl::NoDevice);
  EXPECT_EQ(ask(server.port(), "GET", "/healthz").status, 200);
  EXPECT_EQ(ask(server.port(), "GET", "/readyz").status, 503);
}

}  // namespace
}  // namespace lightwell::test
