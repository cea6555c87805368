#include "server/net/shared.h"

namespace lightwell::net {

bool ByteBudget::take(std::uint64_t bytes) {
  const auto wanted = static_cast<std::int64_t>(bytes);
  if (left_.fetch_sub(wanted) >= wanted) return true;
  left_ += wanted;
  return false;
}

bool BudgetShare::grow_to(std::uint64_t bytes) {
  if (bytes <= taken_) return true;
  if (!budget_.take(bytes - taken_)) return false;
  taken_ = bytes;
  return true;
}

void ConnectionSet::add(const void* connection, std::function<void()> drain) {
  std::lock_guard lock(mutex_);
  if (!draining_) drains_[connection] = std::move(drain);
}

void ConnectionSet::remove(const void* connection) {
  std::lock_guard lock(mutex_);
  drains_.erase(connection);
  if (drains_.empty()) emptied_.notify_all();
}

int ConnectionSet::size() const {
  std::lock_guard lock(mutex_);
  return static_cast<int>(drains_.size());
}

void ConnectionSet::drain_all() {
  std::unordered_map<const void*, std::function<void()>> drains;
  {
    std::lock_guard lock(mutex_);
    draining_ = true;
    drains = drains_;
  }
  for (const auto& [connection, drain] : drains) drain();
}

bool ConnectionSet::draining() const {
  std::lock_guard lock(mutex_);
  return draining_;
}

bool ConnectionSet::wait_until_empty(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  return emptied_.wait_for(lock, limit, [this] { return drains_.empty(); });
}

}  // namespace lightwell::net
