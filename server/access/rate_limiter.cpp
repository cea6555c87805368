#include "server/access/rate_limiter.h"

#include <algorithm>

namespace lightwell {
namespace {

constexpr std::size_t kMostBuckets = 65'536;

double seconds(RateLimiter::Time from, RateLimiter::Time to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

double RateLimiter::take(const std::string& client, Time now) {
  if (per_second_ <= 0.0) return 0.0;
  std::lock_guard lock(mutex_);
  if (buckets_.size() >= kMostBuckets) forget_the_full(now);
  const auto [found, is_new] = buckets_.try_emplace(client, Bucket{burst_, now});
  Bucket& bucket = found->second;
  if (!is_new) {
    bucket.left = std::min(burst_, bucket.left + per_second_ * seconds(bucket.at, now));
    bucket.at = now;
  }
  if (bucket.left < 1.0) return (1.0 - bucket.left) / per_second_;
  bucket.left -= 1.0;
  return 0.0;
}

void RateLimiter::forget_the_full(Time now) {
  std::erase_if(buckets_, [&](const auto& entry) {
    return entry.second.left + per_second_ * seconds(entry.second.at, now) >= burst_;
  });
  // As many clients as that at once are an attack: to let all begin anew is cheaper than to remember them.
  if (buckets_.size() >= kMostBuckets) buckets_.clear();
}

}  // namespace lightwell
