// One picture asked for once, of one or many accumulated frames: POST /v1/render and GET .../frame.
#pragma once

#include <atomic>
#include <future>
#include <memory>

#include "server/render/subject.h"

namespace lightwell {

class RenderJob : public Subject {
 public:
  /// Renders `frames` of the very same shot, each adding to the picture, after as many unseen ones as its settings ask
  /// for; once more if the device is lost meanwhile.
  /// `gone` (may be null) calls it off.
  RenderJob(Shot shot, std::uint32_t frames, std::shared_ptr<std::atomic<bool>> gone);
  /// A job let go of before its end gives an error.
  ~RenderJob() override;

  /// To be taken once. Stages and rays are those of all frames together.
  std::future<Result<Frame>> result() { return promise_.get_future(); }

  SteadyTime due_at(SteadyTime now) override;
  Result<Shot> take_shot(SteadyTime now) override;
  void shot_done(Result<Frame> frame) override;
  bool ended() const override { return ended_; }

 private:
  void end(Result<Frame> result);
  void add_up(const Frame& frame);

  Shot shot_;
  const std::uint32_t frames_;
  std::shared_ptr<std::atomic<bool>> gone_;
  const std::uint32_t unseen_;
  std::uint32_t done_ = 0;  // of both
  bool tried_again_ = false;
  Frame sum_;  // stages, rays and milliseconds so far
  bool ended_ = false;
  std::promise<Result<Frame>> promise_;
};

}  // namespace lightwell
