#include "server/serve.h"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "renderer/image_io/image_io.h"
#include "server/running_server.h"

namespace lightwell {
namespace {

constexpr auto kDrainLimit = std::chrono::seconds(15);
constexpr auto kReadyPoll = std::chrono::milliseconds(20);  // while starting, for signals

sigset_t stop_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGINT);
  ::sigaddset(&set, SIGTERM);
  return set;
}

/// While one lives, SIGINT and SIGTERM of this process come to `wait` instead of ending it. Made before any thread is.
class StopSignals {
 public:
  StopSignals() : set_(stop_signals()) { ::pthread_sigmask(SIG_BLOCK, &set_, &before_); }
  ~StopSignals() { give_back(); }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  void wait() const {
    int which = 0;
    ::sigwait(&set_, &which);
  }
  /// The next one ends the process at once.
  void give_back() const { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  /// True if one came within the time.
  bool wait_for(std::chrono::milliseconds limit) const {
    const timespec time{limit.count() / 1000, (limit.count() % 1000) * 1'000'000};
    return ::sigtimedwait(&set_, nullptr, &time) > 0;
  }

 private:
  sigset_t set_;
  sigset_t before_;
};

bool is_set(const std::shared_future<SourceFacts>& ready) {
  return ready.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// True if a signal came first, or at the same time: it is taken, and nobody else will see it.
bool was_signalled_before(const std::shared_future<SourceFacts>& ready, const StopSignals& signals) {
  while (!is_set(ready))
    if (signals.wait_for(kReadyPoll)) return true;
  return false;
}

void run(const ServeOptions& options, const StopSignals& signals) {
  const auto start = std::chrono::steady_clock::now();
  set_up_log(options.log_format, options.log_level);
  log_event(LogLevel::kInfo, "starting", {{"scene", options.scene}});
  const char* const fault = std::getenv("LIGHTWELL_FAULT");
  RunningServer server(options, with_fault(renderer_source(options.device, options.tracer), fault),
                       encoders_with_fault(fault));
  const bool signalled = was_signalled_before(server.ready(), signals);
  if (!is_set(server.ready())) return;  // nobody has been served yet
  const SourceFacts facts = server.ready().get();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  log_event(LogLevel::kInfo, "ready",
            {{"seconds", took.count()}, {"device", facts.device}, {"why", facts.device_why}, {"tracer", facts.tracer}});
  fmt::print("Lightwell is at {}\n", server.url());
  std::fflush(stdout);
  if (const Status loaded = load_image_codecs(); !loaded)  // before somebody waits for it
    log_event(LogLevel::kError, "no_image_files", {{"why", loaded.error().message()}});
  if (!signalled) signals.wait();
  signals.give_back();  // who asks twice does not want to wait
  log_event(LogLevel::kInfo, "stopping", {{"drain_delay_s", options.drain_delay_s}});
  server.announce_drain();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.drain_delay_s));
  const bool all_ended = server.drain(kDrainLimit);
  log_event(all_ended ? LogLevel::kInfo : LogLevel::kWarning, "stopped",
            {{"all_ended", std::string(all_ended ? "yes" : "no")}});
}

}  // namespace

int serve(const ServeOptions& options) {
  const StopSignals signals;
  try {
    run(options, signals);
    return 0;
  } catch (const SceneRefused& refused) {
    fmt::print(stderr, "{}\n", refused.what());
    return 3;
  } catch (const gl::NoDevice& none) {
    fmt::print(stderr, "{}\n", none.what());
    return 4;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}

}  // namespace lightwell
