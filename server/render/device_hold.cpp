#include "server/render/device_hold.h"

#include <algorithm>

namespace lightwell {

namespace {

constexpr double kLonger = 4.0;                           // times a picture of who is waited for
constexpr auto kLongest = std::chrono::milliseconds(20);  // for an acknowledgement over loopback or a near network
constexpr unsigned kMostMisses = 6;

}  // namespace

bool DeviceHold::is_worth_it(const Seat& seat, const Seat& chosen) const {
  const bool is_light = seat.picture_s > 0.0 && kLonger * seat.picture_s <= chosen.picture_s;
  const bool has_time_left = seat.account->used_s + seat.picture_s <= chosen.account->used_s;
  return !seat.was_due && seat.account != chosen.account && seat.share == Share::kOwn && is_light && has_time_left &&
         seat.passed_over == 0;
}

std::optional<SteadyTime> DeviceHold::until(const Seat& chosen, std::span<Seat> seats, SteadyTime now) {
  for (const Seat& seat : seats) {
    const SteadyTime latest = seat.done_at + kLongest;
    if (now >= latest || !is_worth_it(seat, chosen)) continue;
    if (!awaited_) awaited_ = {seat.subject.get(), now};
    return latest;
  }
  return {};
}

void DeviceHold::ends(const Seat& chosen, std::span<Seat> seats, SteadyTime now) {
  for (Seat& seat : seats)
    if (seat.passed_over > 0 && kLonger * seat.picture_s <= chosen.picture_s) --seat.passed_over;
  if (!awaited_) return;
  const auto seat =
      std::find_if(seats.begin(), seats.end(), [&](const Seat& s) { return s.subject.get() == awaited_->subject; });
  if (seat != seats.end()) {
    const auto held = std::min<SteadyTime::duration>(now - awaited_->since, kLongest);
    seat->account->used_s += std::chrono::duration<double>(held).count();
    seat->misses = &*seat == &chosen ? 0 : std::min(seat->misses + 1, kMostMisses);
    seat->passed_over = seat->misses > 0 ? 1u << seat->misses : 0;
  }
  awaited_.reset();
}

}  // namespace lightwell
