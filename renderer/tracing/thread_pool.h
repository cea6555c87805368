// A fixed set of threads for loops over rays and triangles.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lightwell {

class ThreadPool {
 public:
  /// `threads` counts the caller of `parallel_for`; 0: one per core.
  explicit ThreadPool(unsigned threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  unsigned thread_count() const { return static_cast<unsigned>(workers_.size()) + 1; }

  /// Covers [0, count) by calls of body(begin, end) with begin a multiple of `chunk` and end - begin <= chunk, on all
  /// threads and the caller's; returns when all are done. One loop at a time; `body` must not throw or start another.
  void parallel_for(std::uint32_t count, std::uint32_t chunk,
                    const std::function<void(std::uint32_t begin, std::uint32_t end)>& body);

 private:
  struct Loop {
    const std::function<void(std::uint32_t, std::uint32_t)>* body = nullptr;
    std::uint32_t count = 0;
    std::uint32_t chunk = 1;
  };
  void work();
  void run_chunks(const Loop& loop);

  std::mutex mutex_;
  std::condition_variable started_;
  std::condition_variable finished_;
  Loop loop_;                     // guarded by mutex_
  std::uint64_t generation_ = 0;  // guarded by mutex_; counts the loops
  unsigned wanted_ = 0;           // guarded by mutex_; workers that may still join the loop
  unsigned running_ = 0;          // guarded by mutex_; workers inside the loop
  bool stopping_ = false;         // guarded by mutex_
  std::atomic<std::uint64_t> next_{0};
  std::vector<std::jthread> workers_;
};

}  // namespace lightwell
