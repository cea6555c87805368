// Keeps the device free for a moment before a long picture, which is not interrupted, for one with short ones that is
// about to want its next: it waits for its client, would find the device taken each time, and so get a picture for each
// of the other's, not half of the time. Anticipatory scheduling: Iyer and Druschel 2001.
#pragma once

#include <optional>
#include <span>

#include "server/render/seat.h"

namespace lightwell {

class DeviceHold {
 public:
  /// Until when to wait before `chosen` is rendered; none: not at all. `seats` holds `chosen`.
  std::optional<SteadyTime> until(const Seat& chosen, std::span<Seat> seats, SteadyTime now);

  /// One is about to be rendered. The time that the device was kept is charged to whom it was kept for. Who has not
  /// come is waited for less often.
  void ends(const Seat& chosen, std::span<Seat> seats, SteadyTime now);

 private:
  bool is_worth_it(const Seat& seat, const Seat& chosen) const;

  struct Awaited {
    const Subject* subject;
    SteadyTime since;
  };
  std::optional<Awaited> awaited_;
};

}  // namespace lightwell
