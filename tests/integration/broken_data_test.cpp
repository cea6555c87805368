// What the server keeps cannot be read or written for a while, or any more: it serves on, says so, and recovers.
#include <fstream>

#include "server/data/database.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

ServeOptions options_in(const DataFolder& folder) {
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  return options;
}

class BrokenDataTest : private DataFolder, public ServerTest {
 protected:
  BrokenDataTest() : ServerTest(options_in(*this)) {}

  std::filesystem::path file(const char* name) const { return path() / name; }
  std::string submit(int last_frame) const {
    const json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"last_frame", last_frame}};
    return json::parse(ask("POST", "/v1/sequences", request).body).value("id", "");
  }
  double failures(const std::string& task) const {
    return metric("lightwell_background_failures_total{task=\"" + task + "\"}");
  }
  void expect_that_tasks_fail() const {
    for (const char* task : {"sequences", "kept_sessions", "session_writing", "sequence_frames"})
      EXPECT_TRUE(comes_true([&] { return failures(task) > 1.0; })) << task;
  }
  /// Everything that needs none of what is kept.
  void expect_service(const std::string& session) const {
    EXPECT_EQ(ask("GET", "/readyz").status, 200);
    EXPECT_EQ(ask("POST", "/v1/render", {{"scene", "cornell"}, {"width", 8}, {"height", 8}}).status, 200);
    EXPECT_EQ(ask("PATCH", "/v1/sessions/" + session, {{"time_s", 3}}).status, 200);
    StreamClient client(server_.port(), make_session());
    client.hello();
    EXPECT_TRUE(client.next_frame());
    EXPECT_NE(ask("GET", "/metrics").body.find("\nlightwell_sequence_frames_waiting Nan\n"), std::string::npos);
  }
};

TEST_F(BrokenDataTest, TablesThatFailForAWhileEndNeitherServerNorSequence) {
  const std::string session = make_session();
  studio_->render_ms = 20;
  const std::string sequence = "/v1/sequences/" + submit(30);
  ASSERT_TRUE(comes_true([&] { return json::parse(ask("GET", sequence).body)["frames_done"] > 2; }));
  Database sequences(file("sequences.sqlite")), sessions(file("sessions.sqlite"));
  sequences.execute("ALTER TABLE frames RENAME TO gone; ALTER TABLE servers RENAME TO away");
  sessions.execute("ALTER TABLE sessions RENAME TO gone");
  expect_service(session);
  expect_that_tasks_fail();
  expect_service(session);
  sequences.execute("ALTER TABLE gone RENAME TO frames; ALTER TABLE away RENAME TO servers");
  sessions.execute("ALTER TABLE gone RENAME TO sessions");
  EXPECT_TRUE(comes_true([&] { return ask("GET", sequence + "/archive").status == 200; }));
  EXPECT_EQ(json::parse(ask("GET", sequence).body)["frames_done"], 31);
  EXPECT_EQ(json::parse(ask("GET", "/v1/sessions/" + session).body)["time_s"].get<double>() >= 3.0, true);
}

TEST_F(BrokenDataTest, FilesThatAreOverwrittenDoNotEndTheServer) {
  const std::string session = make_session();
  studio_->held = true;
  submit(3);
  for (const char* name : {"sequences.sqlite", "sessions.sqlite"}) {
    Database(file(name)).execute("PRAGMA wal_checkpoint(TRUNCATE)");
    std::ofstream(file(name), std::ios::binary | std::ios::trunc) << std::string(20'000, '?');
  }
  studio_->held = false;
  for (const char* task : {"sequences", "kept_sessions"})
    EXPECT_TRUE(comes_true([&] { return failures(task) > 1.0; })) << task;
  expect_service(session);
  EXPECT_EQ(ask("GET", "/v1/sequences").status, 500);
}

}  // namespace
}  // namespace lightwell::test
