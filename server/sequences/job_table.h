// The state of all sequences in an SQLite file, which several servers may share: who renders which frame, what is done.
// It outlives every one of them; a frame whose server has died is another's to render.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

#include "protocol/sequence.h"
#include "server/data/database.h"

namespace lightwell {

/// A file of a finished frame.
struct FrameFile {
  std::string name;  // "000012.final.png"
  std::uint64_t bytes = 0;
  std::uint32_t crc32 = 0;

  bool operator==(const FrameFile&) const = default;
};

/// A frame that this server is to render.
struct ClaimedFrame {
  std::string sequence;
  std::uint32_t number = 0;
};

/// A sequence with what only the server knows of it.
struct Job {
  protocol::Sequence sequence;
  std::string scene_digest;
};

/// Thread-safe.
class JobTable {
 public:
  /// Throws std::runtime_error that names the file.
  explicit JobTable(const std::filesystem::path& file);

  /// Adds a sequence, or sets one going again that was cancelled or has failed. False if it was there and goes on, or
  /// is done.
  bool submit(const std::string& id, const protocol::SequenceRequest& request, const nlohmann::json& request_json,
              const std::string& scene_digest);

  std::optional<Job> find(const std::string& id);
  /// Newest first.
  std::vector<protocol::Sequence> list();
  std::optional<protocol::SequenceState> state(const std::string& id);

  /// Ends a sequence that is not done; its finished frames stay. False if there is none such.
  bool end(const std::string& id, protocol::SequenceState state, const std::optional<protocol::Problem>& problem);
  bool remove(const std::string& id);

  /// The next frame that nobody renders, of the sequence that was served longest ago.
  std::optional<ClaimedFrame> claim();
  void release(const ClaimedFrame& frame);
  /// The frame's files are in place.
  void finish(const ClaimedFrame& frame, const std::vector<FrameFile>& files);

  /// The files of one finished frame; empty if it is not finished.
  std::vector<FrameFile> files(const std::string& id, std::uint32_t number);
  /// Of all finished frames, in order.
  std::vector<FrameFile> files(const std::string& id);

  std::uint64_t frames_waiting();
  std::uint64_t bytes();
  bool uses_scene(const std::string& scene_digest);
  /// Sequences that ended before then, Unix time in seconds.
  std::vector<std::string> ended_before(std::int64_t unix_s);

  /// Says that this server lives. To be called at least every second.
  void beat();

 private:
  std::mutex mutex_;
  Database database_;
  const std::string server_;
};

}  // namespace lightwell
