// The threads that render sequences: one waits for the render thread while the other encodes and writes.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "server/operations/background_task.h"
#include "server/render/render_loop.h"
#include "server/sequences/sequence_store.h"

namespace lightwell {

class SequenceWorkers {
 public:
  /// Begin once the render loop is ready. All outlive the workers.
  SequenceWorkers(SequenceStore& store, RenderLoop& render_loop, Metrics& metrics);
  /// Stops the store, lets frames being rendered end, and waits. The render loop may have stopped before.
  ~SequenceWorkers();

 private:
  void run();
  /// Renders a frame if there is one to render. `frame` is what was claimed, until it is finished or another's again.
  void work(std::optional<ClaimedFrame>& frame);
  void render(const ClaimedFrame& frame);
  /// False if the frame was given up.
  protocol::Decoded<std::vector<FrameFile>> make_files(const ClaimedFrame& frame, const SequencePlan& plan,
                                                       const std::shared_ptr<std::atomic<bool>>& given_up);

  SequenceStore& store_;
  RenderLoop& render_loop_;
  BackgroundTask task_;
  std::atomic<bool> stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace lightwell
