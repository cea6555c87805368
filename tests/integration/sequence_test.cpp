// Scripted frames: rendered once, kept on the disk, fetched in every way, whatever happens to the server meanwhile.
#include <filesystem>
#include <future>
#include <latch>

#include "server/sequences/job_table.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

// Without unseen frames, so that as many are rendered as are asked for.
const json kSmall{{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"last_frame", 4}, {"settings", {{"warm_up", 0}}}};

class SequenceTest : public testing::Test {
 protected:
  struct Running {
    std::shared_ptr<FakeStudio> studio = std::make_shared<FakeStudio>();
    std::unique_ptr<RunningServer> server;

    Answer ask(const std::string& method, const std::string& target, const std::string& body = {},
               const std::string& fields = {}) const {
      return test::ask(server->port(), method, target, body, "application/json", fields);
    }
    std::string submit(const json& request, int status = 202) const {
      const Answer answer = ask("POST", "/v1/sequences", request.dump());
      EXPECT_EQ(answer.status, status) << answer.body;
      return json::parse(answer.body).value("id", "");
    }
    json get(const std::string& id) const { return json::parse(ask("GET", "/v1/sequences/" + id).body); }
    json until_done(const std::string& id) const {
      json sequence;
      comes_true([&] { return (sequence = get(id))["state"] == "done" || sequence["state"] == "failed"; });
      return sequence;
    }
  };

  Running start(int render_ms = 1) const {
    Running running;
    running.studio->render_ms = render_ms;
    ServeOptions options = test_options();
    options.data_dir = folder_.path().string();
    options.access.requests_per_second = 0;
    options.limits.max_sequence_frames = 100;
    running.server = std::make_unique<RunningServer>(options, fake_source(running.studio));
    wait_until_ready(*running.server);
    return running;
  }

  const DataFolder folder_;
};

TEST_F(SequenceTest, ServersThatStartAtTheSameMomentShareANewFolder) {
  std::filesystem::create_directories(folder_.path());
  for (int round = 0; round < 20; ++round) {
    const std::filesystem::path file = folder_.path() / (std::to_string(round) + ".sqlite");
    std::latch all_there(6);
    std::vector<std::future<void>> servers;
    for (int i = 0; i < 6; ++i)
      servers.push_back(std::async(std::launch::async, [&] {
        all_there.arrive_and_wait();
        const JobTable table(file);
      }));
    for (std::future<void>& server : servers) EXPECT_NO_THROW(server.get());
  }
}

TEST_F(SequenceTest, IsRenderedAndFetchedFrameByFrameAndAsAZip) {
  const Running server = start();
  const std::string id = server.submit(kSmall);
  const std::string path = "/v1/sequences/" + id;
  const json done = server.until_done(id);
  ASSERT_EQ(done["state"], "done") << done;
  EXPECT_EQ(done["frames_done"], 5);
  EXPECT_EQ(done["request"]["settings"]["samples"], viewing_settings().samples);
  const Answer frame = server.ask("GET", path + "/frames/4");
  ASSERT_EQ(frame.status, 200) << frame.body;
  EXPECT_EQ(frame.field("Content-Type"), "image/png");
  EXPECT_TRUE(frame.body.starts_with("\x89PNG"));
  EXPECT_EQ(server.ask("GET", path + "/frames/4", {}, "If-None-Match: " + frame.field("ETag") + "\r\n").status, 304);
  const Answer zip = server.ask("GET", path + "/archive");
  ASSERT_EQ(zip.status, 200);
  EXPECT_EQ(zip.field("Content-Type"), "application/zip");
  EXPECT_EQ(zip.field("Content-Length"), std::to_string(zip.body.size()));
  EXPECT_TRUE(zip.body.starts_with("PK\x03\x04"));
  EXPECT_NE(zip.body.find("000004.final.png"), std::string::npos);
  EXPECT_NE(zip.body.find(frame.body), std::string::npos);
  EXPECT_EQ(server.ask("GET", path + "/archive").body, zip.body);
  const json list = json::parse(server.ask("GET", "/v1/sequences").body);
  EXPECT_EQ(list["sequences"][0]["id"], id);
}

TEST_F(SequenceTest, TheSameRequestIsNotRenderedAgain) {
  const Running server = start();
  const std::string id = server.submit(kSmall);
  server.until_done(id);
  const int pictures = server.studio->pictures;
  json in_other_words = kSmall;
  in_other_words["fps"] = 30.0;
  in_other_words["edits"] = json::array();
  EXPECT_EQ(server.submit(in_other_words, 200), id);
  const Answer again = server.ask("POST", "/v1/sequences", kSmall.dump());
  EXPECT_EQ(again.field("ETag"), '"' + id + '"');
  EXPECT_EQ(server.studio->pictures, pictures);
  json other = kSmall;
  other["settings"] = {{"seed", 1}};
  EXPECT_NE(server.submit(other), id);
}

TEST_F(SequenceTest, AnotherSceneOfTheSameNameIsAnotherSequence) {
  const Running server = start();
  const auto upload = [&](int triangles) {
    return ask(server.server->port(), "PUT", "/v1/scenes/mine", triangle_glb(triangles), "model/gltf-binary").status;
  };
  json request = kSmall;
  request["scene"] = "mine";
  EXPECT_EQ(upload(1), 201);
  const std::string first = server.submit(request);
  EXPECT_EQ(upload(2), 200);
  EXPECT_NE(server.submit(request), first);
  EXPECT_EQ(upload(1), 200);
  EXPECT_EQ(server.submit(request, 200), first);
}

TEST_F(SequenceTest, GoesOnAfterARestartAndRendersNoFinishedFrameAgain) {
  json request = kSmall;
  request["scene"] = "mine";  // an upload, which the second server was never given
  request["last_frame"] = 99;
  std::string id;
  int done_before = 0;
  std::shared_ptr<FakeStudio> first_studio;
  {
    const Running server = start(30);
    first_studio = server.studio;
    EXPECT_EQ(ask(server.server->port(), "PUT", "/v1/scenes/mine", triangle_glb(), "model/gltf-binary").status, 201);
    id = server.submit(request);
    EXPECT_TRUE(comes_true([&] { return server.get(id)["frames_done"] >= 5; }));
    done_before = server.get(id)["frames_done"];
  }
  EXPECT_GE(done_before, 5);
  EXPECT_LT(done_before, 100);
  const Running server = start();
  const json done = server.until_done(id);
  ASSERT_EQ(done["state"], "done") << done;
  EXPECT_EQ(done["frames_done"], 100);
  EXPECT_LE(server.studio->pictures, 1 + 100 - done_before);  // and one to warm up
  EXPECT_GE(first_studio->pictures + server.studio->pictures, 2 + 100);
}

TEST_F(SequenceTest, ServersThatShareAFolderShareTheWork) {
  const Running first = start(20), second = start(20);
  json request = kSmall;
  request["last_frame"] = 39;
  const std::string id = first.submit(request);
  EXPECT_TRUE(comes_true([&] { return first.studio->pictures > 6; }));
  first.studio->held = true;  // until the other has done its part
  EXPECT_TRUE(comes_true([&] { return second.studio->pictures > 6; }));
  first.studio->held = false;
  EXPECT_EQ(second.until_done(id)["state"], "done");
  EXPECT_GT(first.studio->pictures, 5);
  EXPECT_GT(second.studio->pictures, 5);
  EXPECT_EQ(first.studio->pictures + second.studio->pictures, 40 + 2);  // each has rendered one to warm up
  EXPECT_EQ(first.ask("GET", "/v1/sequences/" + id + "/archive").body,
            second.ask("GET", "/v1/sequences/" + id + "/archive").body);
}

TEST_F(SequenceTest, IsCancelledTakenUpAgainAndForgotten) {
  const Running server = start(20);
  json request = kSmall;
  request["last_frame"] = 99;
  const std::string id = server.submit(request);
  const std::string path = "/v1/sequences/" + id;
  EXPECT_TRUE(comes_true([&] { return server.get(id)["frames_done"] >= 2; }));
  const Answer cancelled = server.ask("POST", path + "/cancel");
  EXPECT_EQ(json::parse(cancelled.body)["state"], "cancelled") << cancelled.body;
  EXPECT_TRUE(server.studio->comes_to_rest());
  EXPECT_LT(server.studio->pictures, 100);
  EXPECT_EQ(problem(server.ask("GET", path + "/archive"))["status"], 409);
  EXPECT_EQ(problem(server.ask("GET", path + "/frames/99"))["status"], 409);
  EXPECT_EQ(problem(server.ask("GET", path + "/frames/100"))["status"], 404);
  EXPECT_EQ(problem(server.ask("GET", path + "/frames/x"))["status"], 404);
  server.studio->render_ms = 1;
  EXPECT_EQ(server.submit(request), id);
  EXPECT_EQ(server.until_done(id)["frames_done"], 100);
  EXPECT_EQ(server.ask("DELETE", path).status, 204);
  EXPECT_EQ(problem(server.ask("GET", path))["status"], 404);
  EXPECT_EQ(problem(server.ask("GET", path + "/frames/0"))["status"], 404);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "sequences"));
}

TEST_F(SequenceTest, TellsItsProgressAsEvents) {
  const Running server = start(20);
  server.studio->held = true;
  const std::string id = server.submit(kSmall);
  Line line(server.server->port());
  line.send("GET /v1/sequences/" + id + "/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(line.receive_until("\r\n\r\n").find("text/event-stream"), std::string::npos);
  const std::string first = line.receive_until("event: running\ndata: {");  // maybe after "queued"
  EXPECT_NE(first.find("event: running\ndata: {"), std::string::npos) << first;
  server.studio->held = false;
  const std::string events = line.receive_until("\r\n0\r\n\r\n");
  EXPECT_NE(events.find("event: done\ndata: {"), std::string::npos) << events;
  EXPECT_NE(events.find("\"frames_done\":5"), std::string::npos) << events;
  line.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(read_answer(line).status, 200);  // the connection goes on
}

TEST_F(SequenceTest, FollowsKeyframesAndTheCamera) {
  const Running server = start();
  json request = kSmall;
  request["camera"] = {{"eye", {0, 0, 4}}, {"target", {0, 0, 0}}};
  request["camera_keyframes"] = {{{"path", "/eye"}, {"times_s", {0, 1}}, {"values", {{0, 0, 4}, {3, 0, 4}}}}};
  request["keyframes"] = {{{"path", "/nodes/0/translation"}, {"times_s", {0, 1}}, {"values", {{0, 0, 0}, {1, 0, 0}}}}};
  request["fps"] = 4;
  ASSERT_EQ(server.until_done(server.submit(request))["state"], "done");
  std::vector<float> eyes;
  for (const FrameRequest& asked : server.studio->requests()) eyes.push_back(asked.camera.world_from_view[3].x);
  std::sort(eyes.begin(), eyes.end());
  const std::vector<float> expected = {0.0f, 0.75f, 1.5f, 2.25f, 3.0f};
  ASSERT_GE(eyes.size(), 5u);
  EXPECT_EQ(std::vector<float>(eyes.end() - 5, eyes.end()), expected);
}

TEST_F(SequenceTest, HasTheSettingsThatSessionsBeginWithUnlessItNamesOthers) {
  const Running server = start();
  json named = kSmall;
  named["settings"]["method"] = "thesis";
  for (const auto& [request, method] : {std::pair(kSmall, Method::kRealtime), {named, Method::kThesis}}) {
    const std::string id = server.submit(request);
    EXPECT_EQ(server.until_done(id)["state"], "done");
    EXPECT_EQ(server.studio->requests().back().settings.method, method);
  }
  json in_words = kSmall;
  in_words["settings"]["method"] = "realtime";
  EXPECT_EQ(server.submit(in_words, 200), server.submit(kSmall, 200)) << "the very same sequence";
}

TEST_F(SequenceTest, HasAllViewsAsLayersOrAsFiles) {
  const Running server = start();
  json request = kSmall;
  request["views"] = {"final", "albedo"};
  const std::string png = "/v1/sequences/" + server.submit(request);
  request["format"] = "exr";
  const std::string exr = "/v1/sequences/" + server.submit(request);
  EXPECT_EQ(server.until_done(png.substr(14))["state"], "done");
  EXPECT_EQ(server.until_done(exr.substr(14))["state"], "done");
  EXPECT_TRUE(server.ask("GET", png + "/frames/0?view=albedo").body.starts_with("\x89PNG"));
  EXPECT_EQ(problem(server.ask("GET", png + "/frames/0?view=depth"))["pointer"], "/view");
  EXPECT_EQ(problem(server.ask("GET", png + "/frames/0?size=1"))["pointer"], "/size");
  const std::string file = server.ask("GET", exr + "/frames/0").body;
  EXPECT_TRUE(file.starts_with("\x76\x2f\x31\x01"));
  for (const char* name : {"albedo.R", "albedo.G", "albedo.B", "lightwell:request", "\"samples\":"})
    EXPECT_NE(file.find(name), std::string::npos) << name;
}

TEST_F(SequenceTest, NamesWhatIsWrong) {
  const Running server = start();
  const auto pointer = [&](const json& change) {
    json request = kSmall;
    request.update(change);
    const Answer answer = server.ask("POST", "/v1/sequences", request.dump());
    EXPECT_EQ(answer.status, 422) << answer.body;
    return problem(answer).value("pointer", "");
  };
  EXPECT_EQ(pointer({{"scene", "nothing"}}), "/scene");
  EXPECT_EQ(pointer({{"last_frame", 100}}), "/last_frame");
  EXPECT_EQ(pointer({{"views", {"final", "x"}}}), "/views/1");
  EXPECT_EQ(pointer({{"settings", {{"method", "magic"}}}}), "/settings/method");
  EXPECT_EQ(pointer({{"camera", {{"index", 50}}}}), "/camera/index");
  const json bad_path{{"path", "/nodes/999/translation"}, {"times_s", {0}}, {"values", {{1, 2, 3}}}};
  EXPECT_EQ(pointer({{"keyframes", {bad_path}}}), "/keyframes/0");
}

TEST_F(SequenceTest, FailsWithTheReasonAndMayBeTriedAgain) {
  const Running server = start();
  server.studio->failing = true;
  const std::string id = server.submit(kSmall);
  const json failed = server.until_done(id);
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["problem"]["status"], 422) << failed;
  server.studio->failing = false;
  EXPECT_EQ(server.submit(kSmall), id);
  EXPECT_EQ(server.until_done(id)["state"], "done");
}

TEST(Sequences, NeedAFolder) {
  RunningServer server(test_options(), fake_source(std::make_shared<FakeStudio>()));
  wait_until_ready(server);
  EXPECT_EQ(problem(ask(server.port(), "GET", "/v1/sequences"))["status"], 503);
}

TEST(Sequences, TellOfAFolderThatCannotBe) {
  ServeOptions options = test_options();
  options.data_dir = "/proc/nothing";
  EXPECT_THROW(RunningServer(options, fake_source(std::make_shared<FakeStudio>())), std::runtime_error);
}

}  // namespace
}  // namespace lightwell::test
