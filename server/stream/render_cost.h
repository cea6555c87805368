// What a picture costs to render by its area: a part that stays, as of an indirect map, and one that grows with it,
// learned from the sizes that were rendered. Pure.
#pragma once

#include <deque>

namespace lightwell {

class RenderCost {
 public:
  /// A picture of so large a share of the full area took so long.
  void rendered(double area, double seconds);

  /// What one would take now; 0 before three of one size were rendered.
  double seconds_at(double area) const;
  /// The area of one that takes so long; may lie outside of what is possible. Only when `seconds_at` is known.
  double area_for(double seconds) const;

 private:
  double seconds_per_area() const;

  std::deque<double> last_s_;                // the last three of one size: a shader that is new is slow only once
  double last_area_ = 0.0;                   // theirs
  double usual_area_ = 0.0, usual_s_ = 0.0;  // their median; 0: not known
  double growth_s_ = 0.0;                    // seconds the full area's part takes; 0: not known, all of it grows
};

}  // namespace lightwell
