#include "server/stream/send_window.h"

#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

constexpr std::size_t kRun = 8;   // arrivals that a number is judged by
constexpr int kPassBetween = 48;  // arrivals from one trial to the next, unless more was better
constexpr double kPauseS = 0.5;   // between arrivals: nothing is to be sent
// One more of n is kept if the power grows by more than this over n; by 1 / n at best.
constexpr double kGain = 0.4;
constexpr double kAlike = 0.2;  // sizes

}  // namespace

void SendWindow::arrived(double bytes, double at_s, double delay_s) {
  const bool goes_on = at_s - last_at_s_ < kPauseS;
  last_at_s_ = at_s;
  if (!goes_on) begin_run(kept_);
  if (int& left = to_skip_ > 0 ? to_skip_ : to_pass_; left > 0) {
    --left;
    run_began_s_ = at_s;
    return;
  }
  run_bytes_ += bytes;
  run_delays_s_.push_back(delay_s);
  if (run_delays_s_.size() < kRun) return;
  if (trial_ != kept_) return end_trial();
  kept_run_ = judge();
  if (kept_ == kLeastOnTheWay) wants_more_ = true;
  if (kept_ == kMostOnTheWay) wants_more_ = false;
  begin_run(kept_ + (wants_more_ ? 1 : -1));
}

void SendWindow::begin_run(int pictures) {
  to_skip_ = pictures == trial_ ? 0 : std::max(pictures, trial_);
  trial_ = pictures;
  run_began_s_ = last_at_s_;
  run_bytes_ = 0.0;
  run_delays_s_.clear();
}

SendWindow::Run SendWindow::judge() const {
  std::vector<double> delays_s = run_delays_s_;
  const auto middle = delays_s.begin() + kRun / 2;
  std::nth_element(delays_s.begin(), middle, delays_s.end());
  const double pictures = static_cast<double>(kRun);
  return {run_bytes_ / pictures, pictures / std::max((last_at_s_ - run_began_s_) * *middle, 1e-9)};
}

/// Pictures that became larger or smaller meanwhile tell nothing of the number.
void SendWindow::end_trial() {
  const Run tried = judge();
  const bool more = trial_ > kept_;
  const double gain = more ? tried.power / kept_run_.power : kept_run_.power / tried.power;
  const bool more_is_better = gain > 1.0 + kGain / std::min(kept_, trial_);
  const bool are_alike = std::abs(tried.bytes - kept_run_.bytes) < kAlike * kept_run_.bytes;
  const bool was_right = are_alike && more == more_is_better;
  if (was_right)
    kept_ = trial_;
  else if (are_alike)
    wants_more_ = !wants_more_;
  to_pass_ = was_right ? 0 : are_alike ? kPassBetween : kPassBetween / 2;
  begin_run(kept_);
}

}  // namespace lightwell
