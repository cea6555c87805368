// How large a picture may be to arrive in time over one viewer's link, and how many may be on their way, learned from
// how long pictures took to be acknowledged. Pure: times come from outside.
#pragma once

#include <cstddef>
#include <deque>

#include "server/stream/send_window.h"

namespace lightwell {

/// One picture that was acknowledged.
struct Arrival {
  double bytes = 0.0;
  double sent_s = 0.0;   // by a clock that all arrivals share
  double delay_s = 0.0;  // from its being sent to its acknowledgement
  double gap_s = 0.0;    // since the acknowledgement before it, if it was on the way then; else 0
};

/// The budget shrinks at once when a picture comes too late, to what would have come in time, and grows slowly while
/// they come in time.
class LinkPace {
 public:
  LinkPace();

  void arrived(const Arrival& arrival);

  /// A picture of so many bytes arrives in time; infinite until one did not.
  double budget_bytes() const { return budget_bytes_; }
  /// What the link carries, at least; 0: not known.
  double bytes_per_s() const;
  /// The delay of a picture of no bytes on an empty link.
  double base_delay_s() const;
  /// The shortest of the last delays: of a picture that waited for no other; 0: not known.
  double least_delay_s() const;
  /// So many pictures may be on the way.
  int most_on_the_way() const { return window_.pictures(); }

 private:
  double too_late_s() const;

  std::deque<double> rates_;      // of the last pictures that followed another closely, bytes a second
  std::deque<Arrival> arrivals_;  // the last
  double budget_bytes_;
  int to_ignore_ = 0;  // arrivals of pictures that were on the way when the budget shrank
  SendWindow window_;
};

}  // namespace lightwell
