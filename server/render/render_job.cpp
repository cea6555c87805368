#include "server/render/render_job.h"

#include <algorithm>

namespace lightwell {

RenderJob::RenderJob(Shot shot, std::uint32_t frames, std::shared_ptr<std::atomic<bool>> gone)
    : shot_(std::move(shot)),
      frames_(std::max(frames, 1u)),
      gone_(std::move(gone)),
      unseen_(static_cast<std::uint32_t>(warm_up_frames(shot_.request.settings))) {}

RenderJob::~RenderJob() {
  end(Error{ErrorKind::kDeviceLost, "", "the server stops"});
}

SteadyTime RenderJob::due_at(SteadyTime now) {
  return ended_ ? kNever : now;
}

Result<Shot> RenderJob::take_shot(SteadyTime) {
  if (gone_ && *gone_) return Error{ErrorKind::kInternal, "", "the client is gone"};
  Shot shot = shot_;
  const bool last = done_ + 1 == unseen_ + frames_;
  shot.request.is_unseen = done_ < unseen_;
  shot.request.accumulate = done_ > unseen_;
  shot.request.want_display = last && shot_.request.want_display;
  shot.request.want_linear = last && shot_.request.want_linear;
  return shot;
}

void RenderJob::shot_done(Result<Frame> frame) {
  const bool lost = !frame && frame.error().kind == ErrorKind::kDeviceLost;
  if (lost && !tried_again_) {  // on the device that is set up anew, from the beginning
    tried_again_ = true;
    done_ = 0;
    sum_ = Frame();
    return;
  }
  if (!frame) return end(std::move(frame));
  add_up(*frame);
  if (++done_ < unseen_ + frames_) return;
  frame->stages = std::move(sum_.stages);
  frame->total_ms = sum_.total_ms;
  frame->rays = sum_.rays;
  end(std::move(frame));
}

void RenderJob::add_up(const Frame& frame) {
  sum_.total_ms += frame.total_ms;
  sum_.rays += frame.rays;
  for (const StageTime& stage : frame.stages) {
    const auto same = std::find_if(sum_.stages.begin(), sum_.stages.end(),
                                   [&](const StageTime& known) { return known.name == stage.name; });
    if (same == sum_.stages.end())
      sum_.stages.push_back(stage);
    else
      same->ms += stage.ms;
  }
}

void RenderJob::end(Result<Frame> result) {
  if (ended_) return;
  ended_ = true;
  promise_.set_value(std::move(result));
}

}  // namespace lightwell
