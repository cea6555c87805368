#include "server/stream/render_cost.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lightwell {
namespace {

constexpr std::size_t kRenderTimes = 3;
constexpr double kLeastGrowth = 0.2;  // of what would be in proportion to the area
constexpr double kOtherArea = 0.05;   // areas that differ by less tell nothing

}  // namespace

void RenderCost::rendered(double area, double seconds) {
  if (area != last_area_) last_s_.clear();
  last_area_ = area;
  last_s_.push_back(seconds);
  if (last_s_.size() > kRenderTimes) last_s_.pop_front();
  if (last_s_.size() < kRenderTimes) return;
  std::vector<double> sorted(last_s_.begin(), last_s_.end());
  std::sort(sorted.begin(), sorted.end());
  const double usual_s = sorted[kRenderTimes / 2];
  if (usual_s_ > 0.0 && std::abs(area - usual_area_) > kOtherArea)
    growth_s_ = (usual_s - usual_s_) / (area - usual_area_);
  usual_area_ = area;
  usual_s_ = usual_s;
}

/// Never less than a part of what would be in proportion, and never more: a machine that became slower or quicker in
/// between tells a wrong growth.
double RenderCost::seconds_per_area() const {
  const double in_proportion = usual_s_ / usual_area_;
  return growth_s_ == 0.0 ? in_proportion : std::clamp(growth_s_, kLeastGrowth * in_proportion, in_proportion);
}

double RenderCost::seconds_at(double area) const {
  return usual_s_ > 0.0 ? usual_s_ + seconds_per_area() * (area - usual_area_) : 0.0;
}

double RenderCost::area_for(double seconds) const {
  return usual_area_ + (seconds - usual_s_) / seconds_per_area();
}

}  // namespace lightwell
