#include "server/stream/link_pace.h"

#include <algorithm>
#include <limits>

namespace lightwell {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr std::size_t kRates = 16;
constexpr std::size_t kArrivals = 64;
constexpr double kShortestGapS = 1e-3;  // acknowledgements that come at once tell nothing of the link
constexpr double kAlwaysInTimeS = 0.2;  // a picture that took no longer
constexpr double kTransferS = 0.1;      // or no longer than this above the link's own delay
constexpr double kReserve = 0.9;        // of what would just have come in time
constexpr double kGrowth = 1.05;        // for each picture in time
constexpr double kLeastBytes = 1024.0;
constexpr double kMostAhead = 4.0;  // times the picture that came in time: beyond, nothing is known

}  // namespace

LinkPace::LinkPace() : budget_bytes_(kUnbounded) {}

double LinkPace::bytes_per_s() const {
  return rates_.empty() ? 0.0 : *std::max_element(rates_.begin(), rates_.end());
}

/// From when the narrow place was free for each, if all went through it one after the other at the rate known.
double LinkPace::base_delay_s() const {
  const double rate = bytes_per_s();
  double least_s = kUnbounded, free_s = 0.0;
  for (const Arrival& arrival : arrivals_) {
    free_s = std::max(free_s, arrival.sent_s) + (rate > 0.0 ? arrival.bytes / rate : 0.0);
    least_s = std::min(least_s, std::max(arrival.delay_s - (free_s - arrival.sent_s), 0.0));
  }
  return arrivals_.empty() ? 0.0 : least_s;
}

double LinkPace::least_delay_s() const {
  const auto by_delay = [](const Arrival& a, const Arrival& b) { return a.delay_s < b.delay_s; };
  return arrivals_.empty() ? 0.0 : std::min_element(arrivals_.begin(), arrivals_.end(), by_delay)->delay_s;
}

double LinkPace::too_late_s() const {
  return std::max(kAlwaysInTimeS, base_delay_s() + kTransferS);
}

void LinkPace::arrived(const Arrival& arrival) {
  if (arrival.gap_s > kShortestGapS) rates_.push_back(arrival.bytes / arrival.gap_s);
  if (rates_.size() > kRates) rates_.pop_front();
  arrivals_.push_back(arrival);
  if (arrivals_.size() > kArrivals) arrivals_.pop_front();
  window_.arrived(arrival.bytes, arrival.sent_s + arrival.delay_s, arrival.delay_s);
  if (to_ignore_ > 0) {
    --to_ignore_;
    return;
  }
  const double base_s = base_delay_s(), too_late_s = this->too_late_s();
  if (arrival.delay_s > too_late_s) {
    const double in_time = arrival.bytes * (too_late_s - base_s) / (arrival.delay_s - base_s);
    budget_bytes_ = std::max(std::min(budget_bytes_, in_time) * kReserve, kLeastBytes);
    to_ignore_ = most_on_the_way();
  } else if (budget_bytes_ < kMostAhead * arrival.bytes) {
    budget_bytes_ *= kGrowth;
  }
}

}  // namespace lightwell
