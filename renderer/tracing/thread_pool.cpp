#include "renderer/tracing/thread_pool.h"

#include <algorithm>

#include "renderer/check.h"

namespace lightwell {

ThreadPool::ThreadPool(unsigned threads) {
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  started_.notify_all();
}

void ThreadPool::parallel_for(std::uint32_t count, std::uint32_t chunk,
                              const std::function<void(std::uint32_t, std::uint32_t)>& body) {
  LIGHTWELL_CHECK_OP(chunk, >, 0u);
  if (count == 0) return;
  const Loop loop{&body, count, chunk};
  const std::uint64_t chunks = (static_cast<std::uint64_t>(count) + chunk - 1) / chunk;
  const unsigned helpers = static_cast<unsigned>(std::min<std::uint64_t>(chunks - 1, workers_.size()));
  next_ = 0;
  if (helpers == 0) return run_chunks(loop);  // waking a thread costs more than one chunk
  {
    const std::lock_guard lock(mutex_);
    loop_ = loop;
    wanted_ = helpers;
    ++generation_;
  }
  started_.notify_all();
  run_chunks(loop);
  std::unique_lock lock(mutex_);
  wanted_ = 0;  // every chunk is taken: a worker that wakes only now has nothing to do
  finished_.wait(lock, [this] { return running_ == 0; });
}

void ThreadPool::work() {
  std::uint64_t seen = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    started_.wait(lock, [&] { return stopping_ || (generation_ != seen && wanted_ > 0); });
    if (stopping_) return;
    seen = generation_;
    --wanted_;
    ++running_;
    const Loop loop = loop_;
    lock.unlock();
    run_chunks(loop);
    lock.lock();
    if (--running_ == 0) finished_.notify_one();
  }
}

void ThreadPool::run_chunks(const Loop& loop) {
  while (true) {
    const std::uint64_t begin = next_.fetch_add(loop.chunk, std::memory_order_relaxed);
    if (begin >= loop.count) return;
    const std::uint64_t end = std::min<std::uint64_t>(begin + loop.chunk, loop.count);
    (*loop.body)(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
  }
}

}  // namespace lightwell
