// Sequences as the routes and the workers see them: submitted, looked at, cancelled, finished, and kept on the disk.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "server/data/scene_files.h"
#include "server/sequences/job_table.h"
#include "server/sequences/sequence_plan.h"

namespace lightwell {

/// What a picture depends on besides its request: "Lightwell 0.1.0, llvmpipe ..., embree".
using RendererIdentity = std::string;

/// Thread-safe.
class SequenceStore {
 public:
  /// Keeps everything in `options.data_dir`. Throws std::runtime_error that names what cannot be made.
  SequenceStore(const ServeOptions& options, const SceneStore& scenes, const SceneFiles& scene_files);

  struct Submitted {
    protocol::Sequence sequence;
    bool begun = false;  // there is something to render
  };
  /// Whatever is wrong with the request is a problem. The same request on the same renderer has the same id.
  protocol::Decoded<Submitted> submit(const protocol::SequenceRequest& request, const RendererIdentity& renderer);

  std::optional<protocol::Sequence> find(const std::string& id);
  std::vector<protocol::Sequence> list() { return table_.list(); }
  /// Frames being rendered are given up; finished ones stay. False if it is not there, or has ended.
  bool cancel(const std::string& id);
  /// Cancels it and forgets its frames.
  bool remove(const std::string& id);
  bool uses_scene(const std::string& digest) { return table_.uses_scene(digest); }

  std::vector<FrameFile> files(const std::string& id) { return table_.files(id); }
  std::vector<FrameFile> files(const std::string& id, std::uint32_t frame) { return table_.files(id, frame); }
  const FrameFolder& folder() const { return folder_; }
  std::uint64_t frames_waiting() { return table_.frames_waiting(); }

  /// `changed` is called, from any thread, whenever the sequence has got on, until the handle returned goes. What
  /// another server does to it is not told: who listens looks from time to time.
  std::shared_ptr<void> listen(const std::string& id, std::function<void()> changed);

  // For workers.

  /// The next frame to render; waits for one up to `limit`.
  std::optional<ClaimedFrame> claim(std::chrono::milliseconds limit);
  void release(const ClaimedFrame& frame) { table_.release(frame); }
  /// What a claimed frame's sequence means; a problem if its scene is gone.
  protocol::Decoded<std::shared_ptr<const SequencePlan>> plan(const std::string& id);
  /// Set when the sequence is cancelled: its renderings are to be given up.
  std::shared_ptr<std::atomic<bool>> given_up(const std::string& id);
  void finish(const ClaimedFrame& frame, const std::vector<FrameFile>& files);
  /// Ends the sequence of a claimed frame.
  void fail(const ClaimedFrame& frame, const protocol::Problem& problem);

  /// Called every second: this server lives; what ended long ago is forgotten.
  void keep_house();
  /// Nothing more is claimed.
  void stop();

 private:
  /// Who listens. Outlives the store for as long as anyone does.
  struct Listeners {
    struct Listener {
      std::string id;
      std::function<void()> changed;
    };
    std::mutex mutex;
    std::map<std::uint64_t, Listener> all;
    std::uint64_t next = 0;
  };

  void tell(const std::string& id);
  void give_up(const std::string& id);
  bool forget(const std::string& id);

  const ServeOptions& options_;
  const SceneStore& scenes_;
  const SceneFiles& scene_files_;
  FrameFolder folder_;  // data_dir/sequences/ID
  JobTable table_;

  std::mutex mutex_;
  std::condition_variable work_;
  bool stopping_ = false;
  std::uint64_t submitted_ = 0;  // how often something was
  std::map<std::string, std::shared_ptr<const SequencePlan>> plans_;
  std::map<std::string, std::shared_ptr<std::atomic<bool>>> given_up_;
  const std::shared_ptr<Listeners> listeners_ = std::make_shared<Listeners>();
};

}  // namespace lightwell
