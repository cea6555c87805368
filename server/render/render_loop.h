// The one thread that owns the graphics device: renders for many subjects, each its fair share of the time.
#pragma once

#include <future>
#include <memory>
#include <optional>

#include "server/render/picture_source.h"
#include "server/render/subject.h"

namespace lightwell {

/// Whose time a subject's pictures are made in: every account of kOwn has a share, all of kJobs have one together.
enum class Share { kOwn, kJobs };

/// A share of the time. Its subjects have equal parts of it.
struct RenderAccount;

class RenderLoop {
 public:
  /// Told of every frame but the warm-up, on the render thread: whose time it took, and how many seconds.
  using Observer = std::function<void(Share share, const Result<Frame>& frame, double seconds)>;

  /// Starts the thread, which makes the source and renders what `warm_up` gives once. `ready` tells when that is done.
  /// When nobody has wanted a picture for some seconds, the same follows in the source's other sizes to warm up.
  RenderLoop(MakePictureSource make_source, std::function<Shot()> warm_up, Observer observer);
  ~RenderLoop();  // stops
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  /// What pictures are made with, once the first has been made; or the exception that `make_source` or `warm_up` threw.
  std::shared_future<SourceFacts> ready() const;
  bool is_ready() const;

  static std::shared_ptr<RenderAccount> make_account();

  /// `account`: of kOwn; null: one for this subject alone.
  void add(std::shared_ptr<Subject> subject, Share share, std::shared_ptr<RenderAccount> account = nullptr);
  /// A subject's answers may have changed: it is due, or has ended. Cheap, from any thread.
  void wake();

  /// Ends after the picture being made, and lets go of all subjects, here and from now on.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightwell
