// Whose turn it is, by a clock of the test's own.
#include "server/render/seating.h"

#include <gtest/gtest.h>

namespace lightwell::test {
namespace {

using std::chrono::milliseconds;

/// Wants its next picture so long after the last, as soon as its client has acknowledged that.
class Acknowledged : public Subject {
 public:
  explicit Acknowledged(milliseconds pause) : pause_(pause) {}
  SteadyTime due_at(SteadyTime) override { return done_at + pause_; }
  Result<Shot> take_shot(SteadyTime) override { return Shot{}; }
  void shot_done(Result<Frame>) override {}
  bool ended() const override { return false; }

  SteadyTime done_at{};
  int pictures = 0;

 private:
  const milliseconds pause_;
};

/// The pictures of a session whose take a millisecond, for each of one that always wants pictures of 60 ms. Fewer time
/// is left to who is waited for: the device stands still meanwhile.
double light_pictures_for_a_heavy_one(milliseconds pause) {
  constexpr milliseconds kLight(1), kHeavy(60);
  Seating seating;
  const auto light = std::make_shared<Acknowledged>(pause), heavy = std::make_shared<Acknowledged>(milliseconds(0));
  seating.add(light, Share::kOwn, nullptr);
  seating.add(heavy, Share::kOwn, nullptr);
  SteadyTime now{}, wake_at{};
  while (heavy->pictures < 100) {
    Seat* const seat = seating.choose(now, wake_at);
    if (!seat) {
      now = wake_at;
      continue;
    }
    auto& subject = static_cast<Acknowledged&>(*seat->subject);
    const milliseconds takes = &subject == light.get() ? kLight : kHeavy;
    seating.begin(*seat, now);
    now += takes;
    subject.done_at = now;
    ++subject.pictures;
    seating.end(*seat, std::chrono::duration<double>(takes).count(), now);
  }
  return light->pictures / 100.0;
}

// It has half of the time with its pauses, for which the device is kept free, save that during the other's picture.
TEST(Seating, ALightSessionThatWaitsForItsClientHasHalfOfTheTimeBesideAHeavyOne) {
  for (const int pause_ms : {0, 2, 9})
    EXPECT_NEAR(light_pictures_for_a_heavy_one(milliseconds(pause_ms)), 1.0 + 59.0 / (1.0 + pause_ms), 1.0) << pause_ms;
}

TEST(Seating, NobodyWaitsForWhoDoesNotCome) {
  EXPECT_NEAR(light_pictures_for_a_heavy_one(milliseconds(40)), 1.0, 0.1);
}

}  // namespace
}  // namespace lightwell::test
