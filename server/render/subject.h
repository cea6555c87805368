// What the render loop renders for: something that says when it wants a picture, and of what.
#pragma once

#include <chrono>
#include <memory>

#include "renderer/renderer.h"

namespace lightwell {

using SteadyTime = std::chrono::steady_clock::time_point;

/// Due never, until the loop is woken.
inline constexpr SteadyTime kNever = SteadyTime::max();

struct Shot {
  std::shared_ptr<const Scene> scene;
  FrameRequest request;
};

/// All calls come from the render thread. A subject keeps its RenderView between shots.
class Subject {
 public:
  virtual ~Subject() = default;
  /// When the next picture is wanted: `now` or earlier for at once. May change whenever the loop is woken.
  virtual SteadyTime due_at(SteadyTime now) = 0;
  /// What to render; asked only when due. An error goes to `shot_done` as it is.
  virtual Result<Shot> take_shot(SteadyTime now) = 0;
  virtual void shot_done(Result<Frame> frame) = 0;
  /// True: wants no more pictures, ever; the loop lets go of it.
  virtual bool ended() const = 0;
};

}  // namespace lightwell
