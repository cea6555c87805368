#include "server/render/render_loop.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/operations/log.h"
#include "server/render/seating.h"

namespace lightwell {

namespace {

using std::chrono::steady_clock;

// Who has waited for the server to start comes at once, and wants a picture at once.
constexpr auto kBeforeWarmingUpMore = std::chrono::seconds(3);

/// A source and those it renders for. Lives on the render thread.
class Studio {
 public:
  Studio(const MakePictureSource& make_source, const RenderLoop::Observer& observer)
      : make_source_(make_source), observer_(observer), source_(make_source()) {}

  PictureSource& source() { return *source_; }

  Seating& seating() { return seating_; }

  void render(Seat& seat) {
    const SteadyTime start = steady_clock::now();
    seating_.begin(seat, start);
    Result<Shot> shot = seat.subject->take_shot(start);
    Result<Frame> frame = shot ? render(*shot, seat.view) : Result<Frame>(shot.error());
    const SteadyTime end = steady_clock::now();
    const double seconds = std::chrono::duration<double>(end - start).count();
    if (shot) observer_(seat.share, frame, seconds);
    seat.subject->shot_done(std::move(frame));
    seating_.end(seat, seconds, end);
  }

  Result<Frame> render(const Shot& shot, std::unique_ptr<RenderView>& view) {
    try {
      if (!source_) source_ = make_source_();
      if (!view) view = source_->make_view();
      Result<Frame> frame = source_->render(*shot.scene, shot.request, *view);
      if (!frame && frame.error().kind == ErrorKind::kDeviceLost) give_up_device(view, frame.error().what);
      return frame;
    } catch (const std::exception& error) {  // no memory, a context that cannot be made
      give_up_device(view, error.what());
      return Error{ErrorKind::kInternal, "renderer", error.what()};
    }
  }

 private:
  /// Everything that lives on the device goes, views first; the next frame sets it up again. The subjects stay.
  void give_up_device(std::unique_ptr<RenderView>& view, const std::string& why) {
    log_event(LogLevel::kError, "device_lost", {{"reason", why}});
    view.reset();
    seating_.drop_views();
    source_.reset();
  }

  const MakePictureSource& make_source_;
  const RenderLoop::Observer& observer_;
  std::unique_ptr<PictureSource> source_;  // null after the device was lost, until the next frame
  Seating seating_;                        // their views go before the source
};

}  // namespace

struct RenderLoop::State {
  void run(const MakePictureSource& make_source, const std::function<Shot()>& warm_up);
  void serve(Studio& studio, Shot warm_up);

  std::mutex mutex;
  std::condition_variable changed;
  struct Arrival {
    std::shared_ptr<Subject> subject;
    Share share;
    std::shared_ptr<RenderAccount> account;
  };
  std::vector<Arrival> arrivals;
  bool woken = false;
  bool stopping = false;
  std::atomic<bool> warm = false;
  std::promise<SourceFacts> ready_promise;
  std::shared_future<SourceFacts> ready = ready_promise.get_future().share();
  Observer observer;
  std::thread thread;
};

void RenderLoop::State::run(const MakePictureSource& make_source, const std::function<Shot()>& warm_up) {
  std::optional<Studio> studio;
  Shot first;
  try {
    studio.emplace(make_source, observer);
    std::unique_ptr<RenderView> view;
    first = warm_up();
    if (Result<Frame> frame = studio->render(first, view); !frame)
      throw std::runtime_error("the first picture failed: " + frame.error().message());
    SourceFacts facts = studio->source().facts();
    warm = true;  // first: who has waited for the facts is not told to wait
    ready_promise.set_value(std::move(facts));
  } catch (...) {
    ready_promise.set_exception(std::current_exception());
    return;
  }
  serve(*studio, std::move(first));
}

void RenderLoop::State::serve(Studio& studio, Shot warm_up) {
  const std::vector<glm::ivec2> sizes = studio.source().sizes_to_warm_up();
  SteadyTime warm_up_from = steady_clock::now() + kBeforeWarmingUpMore;
  std::size_t warmed_up = 0;
  for (;;) {
    {
      std::lock_guard lock(mutex);
      if (stopping) return;
      woken = false;
      for (Arrival& arrival : arrivals)
        studio.seating().add(std::move(arrival.subject), arrival.share, std::move(arrival.account));
      arrivals.clear();
    }
    studio.seating().let_go_of_ended();
    SteadyTime wake_at = kNever;
    if (Seat* seat = studio.seating().choose(steady_clock::now(), wake_at)) {
      studio.render(*seat);
      warm_up_from = steady_clock::now() + kBeforeWarmingUpMore;  // an input would wait for shaders to be compiled
      continue;
    }
    const bool may_warm_up = warmed_up < sizes.size() && !studio.seating().is_held();
    if (may_warm_up) wake_at = std::min(wake_at, warm_up_from);
    if (may_warm_up && steady_clock::now() >= warm_up_from) {  // and nobody waits for a picture
      warm_up.request.size_px = sizes[warmed_up++];
      std::unique_ptr<RenderView> view;
      if (const Result<Frame> frame = studio.render(warm_up, view); !frame)  // who asks for such a picture is told, too
        log_event(LogLevel::kWarning, "warm_up_failed", {{"reason", frame.error().message()}});
      continue;
    }
    std::unique_lock lock(mutex);
    const auto something = [this] { return woken || stopping; };
    if (wake_at == kNever)
      changed.wait(lock, something);
    else
      changed.wait_until(lock, wake_at, something);
  }
}

RenderLoop::RenderLoop(MakePictureSource make_source, std::function<Shot()> warm_up, Observer observer)
    : state_(std::make_unique<State>()) {
  state_->observer = std::move(observer);
  state_->thread = std::thread([state = state_.get(), make_source = std::move(make_source),
                                warm_up = std::move(warm_up)] { state->run(make_source, warm_up); });
}

RenderLoop::~RenderLoop() {
  stop();
}

void RenderLoop::stop() {
  {
    std::lock_guard lock(state_->mutex);
    state_->stopping = true;
  }
  state_->changed.notify_one();
  if (state_->thread.joinable()) state_->thread.join();
  std::lock_guard lock(state_->mutex);
  state_->arrivals.clear();
}

std::shared_future<SourceFacts> RenderLoop::ready() const {
  return state_->ready;
}

bool RenderLoop::is_ready() const {
  return state_->warm;
}

std::shared_ptr<RenderAccount> RenderLoop::make_account() {
  return std::make_shared<RenderAccount>();
}

void RenderLoop::add(std::shared_ptr<Subject> subject, Share share, std::shared_ptr<RenderAccount> account) {
  {
    std::lock_guard lock(state_->mutex);
    if (state_->stopping) return;
    state_->arrivals.push_back({std::move(subject), share, std::move(account)});
    state_->woken = true;
  }
  state_->changed.notify_one();
}

void RenderLoop::wake() {
  {
    std::lock_guard lock(state_->mutex);
    state_->woken = true;
  }
  state_->changed.notify_one();
}

}  // namespace lightwell
