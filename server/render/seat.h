// Those the render loop renders for, and what each has had of the device.
#pragma once

#include <memory>

#include "server/render/picture_source.h"
#include "server/render/render_loop.h"

namespace lightwell {

/// Render time used up, in seconds. Who has used least goes first. One that comes back from idling starts level with
/// the others: idling saves nothing up.
struct RenderAccount {
  double used_s = 0.0;
  double level_s = 0.0;  // what the one of its subjects had used that was served last
};

struct Seat {
  std::shared_ptr<Subject> subject;
  std::shared_ptr<RenderAccount> account;
  Share share = Share::kOwn;
  std::unique_ptr<RenderView> view;
  double used_s = 0.0;     // of the account's, by this subject
  double picture_s = 0.0;  // what a picture takes, smoothed
  SteadyTime done_at{};    // its last picture
  bool was_due = false;
  unsigned misses = 0, passed_over = 0;  // of DeviceHold: how often in vain, and how often it is not waited for now

  /// Jobs come one after another, the subjects of a session by turns.
  bool goes_before(const Seat& other) const {
    if (account != other.account) return account->used_s < other.account->used_s;
    return share == Share::kOwn && used_s < other.used_s;
  }

  /// Has been served.
  void charge(double seconds, SteadyTime now) {
    account->used_s += seconds;
    used_s += seconds;
    picture_s = picture_s > 0.0 ? 0.7 * picture_s + 0.3 * seconds : seconds;
    done_at = now;
  }
};

}  // namespace lightwell
