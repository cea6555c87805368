// What is refused of sequences, their frames and their films.
#include <fstream>

#include "server/data/database.h"
#include "server/video/video_encoder.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/refusals_fixture.h"

namespace lightwell::test {

using std::chrono::milliseconds;

namespace {

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

}  // namespace

void ask_for_what_is_gone(Answers& answers) {
  const DataFolder folder, page;
  std::filesystem::create_directories(page.path());
  std::ofstream(page.path() / "index.html") << "a viewer";
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  options.web_client_dir = page.path().string();
  Asked asked(options);
  asked.until_ready();
  std::filesystem::remove(page.path() / "index.html");
  answers["viewer_file"] = asked.ask("GET", "/");
  const std::string body = R"({"scene":"cornell","width":8,"height":8,"last_frame":0})";
  const std::string id = json::parse(asked.ask("POST", "/v1/sequences", body).body)["id"];
  const std::string done = "/v1/sequences/" + id;
  EXPECT_TRUE(comes_true([&] { return asked.ask("GET", done + "/archive").status == 200; }));
  std::filesystem::remove(folder.path() / "sequences" / id / "000000.final.png");
  answers["frame_file"] = asked.ask("GET", done + "/frames/0");
  // As if the frame were larger than any ZIP, and then as if the disk had failed.
  Database database(folder.path() / "sequences.sqlite");
  database.execute("UPDATE frames SET bytes = 5000000000, files = replace(files, '\"bytes\":', '\"bytes\":5000000')");
  answers["zip"] = asked.ask("GET", done + "/archive");
  database.execute("ALTER TABLE frames RENAME TO others");
  answers["handler"] = asked.ask("GET", done);
  database.execute("ALTER TABLE others RENAME TO frames");
  asked.studio->lost = true;
  answers["device"] = asked.render(json::object());
  asked.studio->lost = false;
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

namespace {

TEST(Refusals, ASequenceWhoseSceneIsGoneFailsAsTheDocumentSays) {
  const DataFolder folder;
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  auto first = std::make_unique<Asked>(options);
  first->until_ready();
  const std::string body = R"({"scene":"cornell","width":8,"height":8,"last_frame":0})";
  const std::string path =
      "/v1/sequences/" + json::parse(first->ask("POST", "/v1/sequences", body).body)["id"].get<std::string>();
  EXPECT_TRUE(comes_true([&] { return first->ask("GET", path + "/archive").status == 200; }));
  first.reset();
  // As if its frame were still to be rendered, and of a scene that was uploaded.
  Database(folder.path() / "sequences.sqlite")
      .execute("UPDATE sequences SET state = 0, scene_digest = 'of another scene'; UPDATE frames SET state = 0");
  Asked second(options);
  second.until_ready();
  json sequence;
  EXPECT_TRUE(comes_true([&] {
    sequence = json::parse(second.ask("GET", path).body);
    return sequence["state"] == "failed";
  }));
  const json document = json::parse(protocol::openapi_document());
  const json& content = document["paths"]["/v1/sequences/{id}"]["get"]["responses"]["200"]["content"];
  const json& shown = content["application/json"]["examples"]["failed"]["value"];
  EXPECT_EQ(sequence["state"], shown["state"]);
  expect_problem("failed", sequence["problem"], shown["problem"]);
}

TEST(Refusals, ASequenceWhoseFrameCannotBeWrittenFailsAsTheDocumentSays) {
  const DataFolder folder;
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  Asked asked(options);
  asked.until_ready();
  std::filesystem::remove_all(folder.path() / "sequences");
  std::ofstream(folder.path() / "sequences") << "where a folder should be";
  const std::string body = R"({"scene":"cornell","width":8,"height":8,"last_frame":0})";
  const std::string path =
      "/v1/sequences/" + json::parse(asked.ask("POST", "/v1/sequences", body).body)["id"].get<std::string>();
  json sequence;
  EXPECT_TRUE(comes_true([&] {
    sequence = json::parse(asked.ask("GET", path).body);
    return sequence["state"] == "failed";
  }));
  const json document = json::parse(protocol::openapi_document());
  const json& content = document["paths"]["/v1/sequences/{id}"]["get"]["responses"]["200"]["content"];
  expect_problem("not_kept", sequence["problem"],
                 content["application/json"]["examples"]["not_kept"]["value"]["problem"]);
}

}  // namespace
}  // namespace lightwell::test
