// The stream's controller on simulated links: no clock but the simulation's.
#include "server/stream/picture_grade.h"

#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "server/stream/link_pace.h"

namespace lightwell::test {
namespace {

struct SimulatedLink {
  double bytes_per_s = 1e9;
  double round_trip_s = 0.001;
};

/// A server that renders and sends as fast as the pictures that may be on the way let it, and a viewer who acknowledges
/// at once.
class Simulation {
 public:
  Simulation(double full_bytes, double full_render_s) : full_bytes_(full_bytes), full_render_s_(full_render_s) {}

  /// Goes on for so long; what it gives tells of that time.
  struct Seen {
    std::vector<double> latency_s;  // from an input at the viewer to the picture of it there
    PictureGrade last;
    double pictures_per_s = 0.0;
  };
  Seen run(const SimulatedLink& link, double seconds) {
    Seen seen;
    const double end_s = now_s_ + seconds;
    while (now_s_ < end_s) {
      take_acknowledgements();
      if (static_cast<int>(in_flight_.size()) >= pace_.most_on_the_way()) {
        now_s_ = in_flight_.front().back_s;
        continue;
      }
      seen.last = grader_.choose(pace_);
      const double interval_s = std::max(0.0166, std::chrono::duration<double>(seen.last.interval).count());
      const double start_s = std::max(now_s_, last_start_s_ + interval_s);
      seen.latency_s.push_back(send_picture(link, seen.last, start_s));
    }
    seen.pictures_per_s = static_cast<double>(seen.latency_s.size()) / seconds;
    return seen;
  }
  /// Of a picture of the full size; `fixed_s` of it whatever the size.
  void set_render_s(double seconds, double fixed_s = 0.0) {
    full_render_s_ = seconds;
    fixed_render_s_ = fixed_s;
  }
  int most_on_the_way() const { return pace_.most_on_the_way(); }

 private:
  struct InFlight {
    double back_s;  // the acknowledgement
    Arrival arrival;
  };

  void take_acknowledgements() {
    for (; !in_flight_.empty() && in_flight_.front().back_s <= now_s_; in_flight_.pop_front()) {
      InFlight& first = in_flight_.front();
      if (first.arrival.sent_s < last_back_s_) first.arrival.gap_s = first.back_s - last_back_s_;
      last_back_s_ = first.back_s;
      pace_.arrived(first.arrival);
    }
  }

  double send_picture(const SimulatedLink& link, const PictureGrade& grade, double start_s) {
    const double area = grade.scale * grade.scale;
    const double render_s = std::lerp(fixed_render_s_, full_render_s_, area);
    const double bytes = full_bytes_ * area * std::pow(grade.quality / 80.0, 0.9) * noise_(random_);
    grader_.made(grade, bytes, render_s);
    const double sent_s = start_s + render_s;
    link_free_s_ = std::max(link_free_s_, sent_s) + bytes / link.bytes_per_s;
    const double there_s = link_free_s_ + link.round_trip_s / 2.0;
    const double back_s = there_s + link.round_trip_s / 2.0;
    in_flight_.push_back({back_s, {bytes, sent_s, back_s - sent_s, 0.0}});
    // An input that came at some time since the last picture was begun.
    const double input_s = std::lerp(last_start_s_, start_s, share_(random_)) - link.round_trip_s / 2.0;
    now_s_ = sent_s;
    last_start_s_ = start_s;
    return there_s - input_s;
  }

  double full_bytes_, full_render_s_, fixed_render_s_ = 0.0;
  LinkPace pace_;
  PictureGrader grader_{80};
  std::deque<InFlight> in_flight_;
  double now_s_ = 0.0, last_start_s_ = 0.0, last_back_s_ = 0.0, link_free_s_ = 0.0;
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> noise_{0.85, 1.15}, share_{0.0, 1.0};
};

double p95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() * 95 / 100];
}

constexpr SimulatedLink kLoopback{1e9, 0.0005}, kSlow{500e3, 0.1}, kVerySlow{60e3, 0.1}, kFar{5e6, 0.3};

TEST(PictureGrade, GivesNothingUpWhereThereIsRoom) {
  Simulation simulation(73e3, 0.02);
  const auto seen = simulation.run(kLoopback, 10.0);
  EXPECT_EQ(seen.last.quality, 80);
  EXPECT_EQ(seen.last.scale, 1.0);
  EXPECT_GT(seen.pictures_per_s, 45.0);
}

TEST(PictureGrade, KeepsTheLatencyOfASlowLinkBounded) {
  for (const double full_bytes : {24e3, 73e3, 200e3}) {
    Simulation simulation(full_bytes, 0.02);
    simulation.run(kSlow, 3.0);  // to learn
    const auto seen = simulation.run(kSlow, 30.0);
    EXPECT_LT(p95(seen.latency_s), 0.4) << full_bytes;
    EXPECT_GT(seen.pictures_per_s, 5.0) << full_bytes;
  }
}

TEST(PictureGrade, GivesUpQualityThenResolutionThenRate) {
  Simulation small(24e3, 0.02), large(73e3, 0.02), huge(600e3, 0.02);
  const PictureGrade quality = (small.run(kSlow, 10.0), small.run(kSlow, 1.0).last);
  EXPECT_EQ(quality.scale, 1.0);
  const PictureGrade resolution = (large.run({150e3, 0.1}, 10.0), large.run({150e3, 0.1}, 1.0).last);
  EXPECT_LT(resolution.quality, 60);
  EXPECT_LT(resolution.scale, 1.0);
  EXPECT_EQ(resolution.interval.count(), 0);
  const auto rate = (huge.run(kVerySlow, 20.0), huge.run(kVerySlow, 10.0));
  EXPECT_EQ(rate.last.scale, 0.25);
  EXPECT_GT(rate.last.interval.count(), 0);
}

TEST(PictureGrade, ALongWayIsNotTakenForASlowLink) {
  Simulation simulation(73e3, 0.02);
  EXPECT_EQ(simulation.run(kFar, 10.0).last.scale, 1.0);
  EXPECT_GE(simulation.run(kFar, 1.0).last.quality, 68);
}

TEST(PictureGrade, TakesBackWhatItGaveUpWhenTheLinkIsBetterAgain) {
  Simulation simulation(73e3, 0.02);
  simulation.run(kLoopback, 5.0);
  const auto slow = (simulation.run(kSlow, 3.0), simulation.run(kSlow, 20.0));
  EXPECT_LT(p95(slow.latency_s), 0.4);
  EXPECT_LT(slow.last.quality, 80);
  const auto quick = simulation.run(kLoopback, 15.0);
  EXPECT_EQ(quick.last.quality, 80);
  EXPECT_EQ(quick.last.scale, 1.0);
}

TEST(PictureGrade, GivesUpResolutionWhereRenderingIsSlow) {
  Simulation simulation(73e3, 0.4);
  const auto slow = simulation.run(kLoopback, 10.0);
  EXPECT_EQ(slow.last.quality, 80);
  EXPECT_NEAR(slow.last.scale, std::sqrt(0.12 / 0.4), 0.05);
  simulation.set_render_s(0.05);
  EXPECT_EQ(simulation.run(kLoopback, 5.0).last.scale, 1.0);
}

TEST(PictureGrade, TheResolutionComesBackWhereItSavedLittle) {
  Simulation simulation(24e3, 0.3);
  simulation.set_render_s(0.3, 0.15);
  EXPECT_LT(simulation.run(kLoopback, 10.0).last.scale, 1.0);
  simulation.set_render_s(0.06, 0.03);
  EXPECT_EQ(simulation.run(kLoopback, 5.0).last.scale, 1.0);
}

TEST(PictureGrade, TheResolutionSettlesWhereRenderingIsSlow) {
  for (const double fixed_s : {0.0, 0.05, 0.1}) {
    Simulation simulation(24e3, 0.2);
    simulation.set_render_s(0.2, fixed_s);
    simulation.run(kLoopback, 10.0);
    const double scale = simulation.run(kLoopback, 0.5).last.scale;
    EXPECT_LE(std::lerp(fixed_s, 0.2, scale * scale), 0.15) << fixed_s;
    for (int i = 0; i < 50; ++i) EXPECT_EQ(simulation.run(kLoopback, 0.2).last.scale, scale) << fixed_s;
  }
}

TEST(PictureGrade, RenderingIsQuickerOverALongWay) {
  Simulation simulation(22e3, 0.14);
  EXPECT_EQ(simulation.run(kLoopback, 5.0).last.scale, 1.0);
  simulation.run(kSlow, 15.0);
  const auto seen = simulation.run(kSlow, 10.0);
  EXPECT_LT(seen.last.scale, 1.0);
  EXPECT_LT(p95(seen.latency_s), 0.35);
}

TEST(PictureGrade, ALongWayDoesNotHoldTheStreamUp) {
  Simulation simulation(20e3, 0.05);
  simulation.run(kSlow, 5.0);
  const auto seen = simulation.run(kSlow, 20.0);
  EXPECT_GT(seen.pictures_per_s, 18.0);
  EXPECT_LT(p95(seen.latency_s), 0.3);
  EXPECT_EQ(seen.last.scale, 1.0);
}

TEST(PictureGrade, PicturesDoNotQueueBeforeANarrowPlace) {
  Simulation near(200e3, 0.02);
  int more = 0;
  for (int i = 0; i < 200; ++i) {
    near.run({500e3, 0.01}, 0.1);
    more += near.most_on_the_way() > kLeastOnTheWay ? 1 : 0;
  }
  EXPECT_LT(more, 50) << "tried now and then";
  Simulation loopback(73e3, 0.02);
  loopback.run(kLoopback, 20.0);
  EXPECT_LE(loopback.most_on_the_way(), kLeastOnTheWay + 1);
}

TEST(PictureGrade, ScalesToEvenSidesThatStayInBounds) {
  PictureGrade grade;
  EXPECT_EQ(grade.scaled({513, 7}), glm::ivec2(513, 7));
  grade.scale = 0.25;
  EXPECT_EQ(grade.scaled({1280, 720}), glm::ivec2(320, 180));
  EXPECT_EQ(grade.scaled({40, 7}), glm::ivec2(16, 7));
}

}  // namespace
}  // namespace lightwell::test
