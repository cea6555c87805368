// How large a picture may be to arrive in time over one viewer's link, learned from how long pictures took to be
// acknowledged. Pure: times come from outside.
#pragma once

#include <cstddef>
#include <deque>

namespace lightwell {

/// One picture that was acknowledged.
struct Arrival {
  double bytes = 0.0;
  double bytes_on_the_way = 0.0;  // when it was sent: its own, and those of pictures not acknowledged then
  double delay_s = 0.0;           // from its being sent to its acknowledgement
  double gap_s = 0.0;             // since the acknowledgement before it, if it was on the way then; else 0
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

 private:
  double too_late_s() const;

  std::deque<double> rates_;      // of the last pictures that followed another closely, bytes a second
  std::deque<Arrival> arrivals_;  // the last
  double budget_bytes_;
  int to_ignore_ = 0;  // arrivals of pictures that were on the way when the budget shrank
};

}  // namespace lightwell
