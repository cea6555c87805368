// How many pictures may be on the way to a viewer at once, found by trying one more and one less. Pure.
#pragma once

#include <vector>

namespace lightwell {

inline constexpr int kLeastOnTheWay = 2, kMostOnTheWay = 6;  // pictures sent and not acknowledged

/// Over a long way a stream has more pictures a second where more are under way. Where a narrow place or the client
/// itself holds them up, more only wait longer: so a number is kept that has the greater power, the rate over the delay
/// (Kleinrock 1979), and the smaller of two that are alike.
class SendWindow {
 public:
  /// A picture was acknowledged at `at_s` by any clock, `delay_s` after it was sent.
  void arrived(double bytes, double at_s, double delay_s);

  int pictures() const { return trial_; }

 private:
  struct Run {
    double bytes = 0.0;  // of a picture
    double power = 0.0;  // pictures a second, by seconds of delay
  };

  void begin_run(int pictures);
  Run judge() const;
  void end_trial();

  int kept_ = kLeastOnTheWay, trial_ = kLeastOnTheWay;  // what is kept to; what is used now
  Run kept_run_;
  bool wants_more_ = true;  // the next trial is with one more, not with one less
  int to_pass_ = 0;         // arrivals until the next trial
  int to_skip_ = 0;         // of pictures that were on the way when the number changed
  double last_at_s_ = 0.0;
  double run_began_s_ = 0.0;
  double run_bytes_ = 0.0;
  std::vector<double> run_delays_s_;  // of pictures that came one after the other without a pause
};

}  // namespace lightwell
