#include "server/sequences/job_table.h"

#include <chrono>

#include "protocol/codec.h"
#include "server/random_id.h"

namespace lightwell {
namespace {

using protocol::SequenceState;
using Lock = std::lock_guard<std::mutex>;

constexpr std::int64_t kDeadAfterS = 5;  // without a beat

// A frame's state: 0 waits, 1 is rendered by `server`, 2 is done.
// A sequence's: 0 goes on, 1 is done, 2 has failed, 3 was cancelled.
constexpr const char* kSchema = R"(
  PRAGMA journal_mode = WAL;
  PRAGMA synchronous = NORMAL;
  CREATE TABLE IF NOT EXISTS sequences(id TEXT PRIMARY KEY, state INTEGER NOT NULL, request TEXT NOT NULL,
    scene_digest TEXT NOT NULL, problem TEXT NOT NULL DEFAULT '', submitted_s INTEGER NOT NULL,
    served INTEGER NOT NULL DEFAULT 0, ended_s INTEGER NOT NULL DEFAULT 0);
  CREATE TABLE IF NOT EXISTS frames(sequence TEXT NOT NULL, number INTEGER NOT NULL, state INTEGER NOT NULL DEFAULT 0,
    server TEXT NOT NULL DEFAULT '', files TEXT NOT NULL DEFAULT '[]', bytes INTEGER NOT NULL DEFAULT 0,
    PRIMARY KEY(sequence, number)) WITHOUT ROWID;
  CREATE INDEX IF NOT EXISTS unfinished ON frames(sequence, number) WHERE state < 2;
  CREATE TABLE IF NOT EXISTS servers(id TEXT PRIMARY KEY, beat_s INTEGER NOT NULL);
)";

constexpr const char* kSelectSequences =
    "SELECT id, sequences.state, request, scene_digest, problem, count(number), sum(frames.state = 2), "
    "sum(frames.state = 1),"
    " sum(bytes) FROM sequences JOIN frames ON sequence = id ";

std::int64_t unix_seconds() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::int64_t number_of(SequenceState state) {
  switch (state) {
    case SequenceState::kDone:
      return 1;
    case SequenceState::kFailed:
      return 2;
    case SequenceState::kCancelled:
      return 3;
    default:
      return 0;
  }
}

SequenceState state_of(std::int64_t number, bool begun) {
  constexpr SequenceState kEnded[] = {SequenceState::kDone, SequenceState::kFailed, SequenceState::kCancelled};
  if (number >= 1 && number <= 3) return kEnded[number - 1];
  return begun ? SequenceState::kRunning : SequenceState::kQueued;
}

Job job_of(const Statement& row) {
  Job job;
  protocol::Sequence& sequence = job.sequence;
  sequence.id = row.text(0);
  sequence.request = nlohmann::json::parse(row.text(2));
  job.scene_digest = row.text(3);
  sequence.frames_total = static_cast<std::uint32_t>(row.integer(5));
  sequence.frames_done = static_cast<std::uint32_t>(row.integer(6));
  sequence.bytes = static_cast<std::uint64_t>(row.integer(8));
  sequence.state = state_of(row.integer(1), sequence.frames_done + row.integer(7) > 0);
  if (const std::string text = row.text(4); !text.empty()) {
    const nlohmann::json problem = nlohmann::json::parse(text);
    sequence.problem = protocol::make_problem(problem.value("status", 500), problem.value("detail", std::string()),
                                              problem.value("pointer", std::string()));
  }
  return job;
}

void append_files(std::vector<FrameFile>& all, const std::string& text) {
  for (const nlohmann::json& file : nlohmann::json::parse(text))
    all.push_back({file.at("name"), file.at("bytes"), file.at("crc32")});
}

}  // namespace

JobTable::JobTable(const std::filesystem::path& file) : database_(file), server_(random_id()) {
  database_.set_up(kSchema);
  beat();
}

bool JobTable::submit(const std::string& id, const protocol::SequenceRequest& request,
                      const nlohmann::json& request_json, const std::string& scene_digest) {
  Lock lock(mutex_);
  Transaction transaction(database_);
  Statement again(database_, "UPDATE sequences SET state = 0, problem = '', ended_s = 0 WHERE id = ?1 AND state > 1");
  again.bind(id).run();
  const bool goes_on_again = database_.changes() > 0;
  Statement add(database_,
                "INSERT OR IGNORE INTO sequences(id, state, request, scene_digest, submitted_s)"
                " VALUES(?1, 0, ?2, ?3, ?4)");
  add.bind(id).bind(protocol::json_text(request_json)).bind(scene_digest).bind(unix_seconds()).run();
  const bool is_new = database_.changes() > 0;
  if (is_new)
    Statement(database_,
              "WITH RECURSIVE n(i) AS (SELECT ?2 UNION ALL SELECT i + 1 FROM n WHERE i < ?3)"
              " INSERT INTO frames(sequence, number) SELECT ?1, i FROM n")
        .bind(id)
        .bind(std::int64_t{request.first_frame})
        .bind(std::int64_t{request.last_frame})
        .run();
  transaction.commit();
  return is_new || goes_on_again;
}

std::optional<Job> JobTable::find(const std::string& id) {
  Lock lock(mutex_);
  Statement row(database_, (std::string(kSelectSequences) + "WHERE id = ?1 GROUP BY id").c_str());
  if (!row.bind(id).next()) return {};
  return job_of(row);
}

std::vector<protocol::Sequence> JobTable::list() {
  Lock lock(mutex_);
  Statement row(database_, (std::string(kSelectSequences) + "GROUP BY id ORDER BY submitted_s DESC, id").c_str());
  std::vector<protocol::Sequence> all;
  while (row.next()) all.push_back(job_of(row).sequence);
  return all;
}

std::optional<SequenceState> JobTable::state(const std::string& id) {
  Lock lock(mutex_);
  Statement row(database_, "SELECT state FROM sequences WHERE id = ?1");
  if (!row.bind(id).next()) return {};
  return state_of(row.integer(0), true);
}

bool JobTable::end(const std::string& id, SequenceState state, const std::optional<protocol::Problem>& problem) {
  Lock lock(mutex_);
  Statement end(database_, "UPDATE sequences SET state = ?2, problem = ?3, ended_s = ?4 WHERE id = ?1 AND state = 0");
  end.bind(id).bind(number_of(state)).bind(problem ? protocol::json_text(protocol::to_json(*problem)) : std::string());
  end.bind(unix_seconds()).run();
  return database_.changes() > 0;
}

bool JobTable::remove(const std::string& id) {
  Lock lock(mutex_);
  Transaction transaction(database_);
  Statement(database_, "DELETE FROM frames WHERE sequence = ?1").bind(id).run();
  Statement(database_, "DELETE FROM sequences WHERE id = ?1").bind(id).run();
  const bool was_there = database_.changes() > 0;
  transaction.commit();
  return was_there;
}

std::optional<ClaimedFrame> JobTable::claim() {
  Lock lock(mutex_);
  Transaction transaction(database_);
  ClaimedFrame frame;
  {
    Statement row(database_,
                  "SELECT id, number FROM sequences JOIN frames ON sequence = id WHERE sequences.state = 0 AND"
                  " frames.state < 2 AND (frames.state = 0 OR server NOT IN"
                  " (SELECT servers.id FROM servers WHERE beat_s >= ?1)) ORDER BY served, submitted_s, number LIMIT 1");
    if (!row.bind(unix_seconds() - kDeadAfterS).next()) return {};
    frame = {row.text(0), static_cast<std::uint32_t>(row.integer(1))};
  }
  Statement(database_, "UPDATE frames SET state = 1, server = ?3 WHERE sequence = ?1 AND number = ?2")
      .bind(frame.sequence)
      .bind(std::int64_t{frame.number})
      .bind(server_)
      .run();
  Statement(database_, "UPDATE sequences SET served = (SELECT max(served) + 1 FROM sequences) WHERE id = ?1")
      .bind(frame.sequence)
      .run();
  transaction.commit();
  return frame;
}

void JobTable::release(const ClaimedFrame& frame) {
  Lock lock(mutex_);
  Statement(database_, "UPDATE frames SET state = 0 WHERE sequence = ?1 AND number = ?2 AND state = 1 AND server = ?3")
      .bind(frame.sequence)
      .bind(std::int64_t{frame.number})
      .bind(server_)
      .run();
}

void JobTable::finish(const ClaimedFrame& frame, const std::vector<FrameFile>& files) {
  nlohmann::json list = nlohmann::json::array();
  std::uint64_t bytes = 0;
  for (const FrameFile& file : files) {
    list.push_back({{"name", file.name}, {"bytes", file.bytes}, {"crc32", file.crc32}});
    bytes += file.bytes;
  }
  Lock lock(mutex_);
  Transaction transaction(database_);
  Statement(database_, "UPDATE frames SET state = 2, files = ?3, bytes = ?4 WHERE sequence = ?1 AND number = ?2")
      .bind(frame.sequence)
      .bind(std::int64_t{frame.number})
      .bind(list.dump())
      .bind(static_cast<std::int64_t>(bytes))
      .run();
  Statement(database_,
            "UPDATE sequences SET state = 1, ended_s = ?2 WHERE id = ?1 AND state = 0 AND NOT EXISTS"
            " (SELECT 1 FROM frames WHERE sequence = ?1 AND frames.state < 2)")
      .bind(frame.sequence)
      .bind(unix_seconds())
      .run();
  transaction.commit();
}

std::vector<FrameFile> JobTable::files(const std::string& id, std::uint32_t number) {
  Lock lock(mutex_);
  Statement row(database_, "SELECT files FROM frames WHERE sequence = ?1 AND number = ?2 AND state = 2");
  std::vector<FrameFile> all;
  if (row.bind(id).bind(std::int64_t{number}).next()) append_files(all, row.text(0));
  return all;
}

std::vector<FrameFile> JobTable::files(const std::string& id) {
  Lock lock(mutex_);
  Statement row(database_, "SELECT files FROM frames WHERE sequence = ?1 AND state = 2 ORDER BY number");
  row.bind(id);
  std::vector<FrameFile> all;
  while (row.next()) append_files(all, row.text(0));
  return all;
}

std::uint64_t JobTable::frames_waiting() {
  Lock lock(mutex_);
  Statement row(database_,
                "SELECT count(*) FROM sequences JOIN frames ON sequence = id WHERE sequences.state = 0"
                " AND frames.state < 2");
  return row.next() ? static_cast<std::uint64_t>(row.integer(0)) : 0;
}

std::uint64_t JobTable::bytes() {
  Lock lock(mutex_);
  Statement row(database_, "SELECT sum(bytes) FROM frames");
  return row.next() ? static_cast<std::uint64_t>(row.integer(0)) : 0;
}

bool JobTable::uses_scene(const std::string& scene_digest) {
  Lock lock(mutex_);
  Statement row(database_, "SELECT 1 FROM sequences WHERE scene_digest = ?1 LIMIT 1");
  return row.bind(scene_digest).next();
}

std::vector<std::string> JobTable::ended_before(std::int64_t unix_s) {
  Lock lock(mutex_);
  Statement row(database_, "SELECT id FROM sequences WHERE state > 0 AND ended_s < ?1");
  row.bind(unix_s);
  std::vector<std::string> ids;
  while (row.next()) ids.push_back(row.text(0));
  return ids;
}

void JobTable::beat() {
  Lock lock(mutex_);
  const std::int64_t now_s = unix_seconds();
  Statement(database_, "INSERT OR REPLACE INTO servers(id, beat_s) VALUES(?1, ?2)").bind(server_).bind(now_s).run();
  Statement(database_, "DELETE FROM servers WHERE beat_s < ?1").bind(now_s - 10 * kDeadAfterS).run();
}

}  // namespace lightwell
