// How many requests a client may send: a bucket of them for each client, filled at a steady rate.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <unordered_map>

namespace lightwell {

/// Thread-safe.
class RateLimiter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `per_second` requests on the whole, `burst` of them at once. 0 a second: no limit.
  RateLimiter(double per_second, double burst) : per_second_(per_second), burst_(burst) {}

  /// Seconds to wait before the client's next request; 0 if this one is taken.
  double take(const std::string& client, Time now);

 private:
  struct Bucket {
    double left = 0.0;
    Time at{};
  };

  void forget_the_full(Time now);

  const double per_second_, burst_;
  std::mutex mutex_;
  std::unordered_map<std::string, Bucket> buckets_;  // a client whose bucket is full needs none
};

}  // namespace lightwell
