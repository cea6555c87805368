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

void ConnectionSet::add(const void* connection, ConnectionCalls calls) {
  std::lock_guard lock(mutex_);
  (draining_ ? late_ : open_)[connection] = std::move(calls);
}

void ConnectionSet::remove(const void* connection) {
  std::lock_guard lock(mutex_);
  late_.erase(connection);
  open_.erase(connection);
  if (open_.empty()) emptied_.notify_all();
}

int ConnectionSet::size() const {
  std::lock_guard lock(mutex_);
  return static_cast<int>(open_.size());
}

void ConnectionSet::drain_all() {
  Calls open;
  {
    std::lock_guard lock(mutex_);
    draining_ = true;
    open = open_;
  }
  for (const auto& [connection, calls] : open) calls.drain();
}

void ConnectionSet::let_go_all() {
  Calls all;
  {
    std::lock_guard lock(mutex_);
    all = open_;
    all.insert(late_.begin(), late_.end());
  }
  for (const auto& [connection, calls] : all) calls.let_go();
}

bool ConnectionSet::draining() const {
  std::lock_guard lock(mutex_);
  return draining_;
}

bool ConnectionSet::wait_until_empty(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  return emptied_.wait_for(lock, limit, [this] { return open_.empty(); });
}

}  // namespace lightwell::net
