// Whose turn it is on the device. Pure: times come from outside.
#pragma once

#include <vector>

#include "server/render/device_hold.h"
#include "server/render/seat.h"

namespace lightwell {

class Seating {
 public:
  /// `account`: null for one of its own; jobs have theirs together in any case.
  void add(std::shared_ptr<Subject> subject, Share share, std::shared_ptr<RenderAccount> account);
  void let_go_of_ended();

  /// The seat whose turn it is, or none; `wake_at` is when one is due next, or the device has been kept long enough.
  Seat* choose(SteadyTime now, SteadyTime& wake_at);
  /// Somebody wants a picture, but not yet.
  bool is_held() const { return is_held_; }

  /// A picture for the seat begins.
  void begin(Seat& seat, SteadyTime now);
  /// It took so long, and is done.
  void end(Seat& seat, double seconds, SteadyTime now) { seat.charge(seconds, now); }

  void drop_views();

 private:
  std::vector<Seat> seats_;
  std::shared_ptr<RenderAccount> jobs_ = std::make_shared<RenderAccount>();
  DeviceHold hold_;
  bool is_held_ = false;
  double level_s_ = 0.0;  // the account of who was served last: the least of those that wait
};

}  // namespace lightwell
