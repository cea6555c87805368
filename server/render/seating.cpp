#include "server/render/seating.h"

#include <algorithm>

namespace lightwell {

void Seating::add(std::shared_ptr<Subject> subject, Share share, std::shared_ptr<RenderAccount> account) {
  if (share == Share::kJobs) account = jobs_;
  if (!account) account = RenderLoop::make_account();
  Seat& seat = seats_.emplace_back();
  seat.subject = std::move(subject);
  seat.account = std::move(account);
  seat.share = share;
}

void Seating::let_go_of_ended() {
  std::erase_if(seats_, [](const Seat& seat) { return seat.subject->ended(); });
}

Seat* Seating::choose(SteadyTime now, SteadyTime& wake_at) {
  Seat* chosen = nullptr;
  wake_at = kNever;
  for (Seat& seat : seats_) {
    const SteadyTime due = seat.subject->due_at(now);
    const bool is_due = due <= now;
    if (is_due && !seat.was_due) {
      seat.account->used_s = std::max(seat.account->used_s, level_s_);
      seat.used_s = std::max(seat.used_s, seat.account->level_s);
    }
    seat.was_due = is_due;
    if (!is_due)
      wake_at = std::min(wake_at, due);
    else if (!chosen || seat.goes_before(*chosen))
      chosen = &seat;
  }
  const std::optional<SteadyTime> held_until = chosen ? hold_.until(*chosen, seats_, now) : std::nullopt;
  is_held_ = held_until.has_value();
  if (!is_held_) return chosen;
  wake_at = std::min(wake_at, *held_until);
  return nullptr;
}

void Seating::begin(Seat& seat, SteadyTime now) {
  hold_.ends(seat, seats_, now);
  level_s_ = std::max(level_s_, seat.account->used_s);
  seat.account->level_s = std::max(seat.account->level_s, seat.used_s);
}

void Seating::drop_views() {
  for (Seat& seat : seats_) seat.view.reset();
}

}  // namespace lightwell
