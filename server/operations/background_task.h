// Work that is done again and again while nobody waits, and that may fail for a while: a disk is full, a file is locked
// or broken. It must neither end the process nor fill the log.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <string>
#include <utility>

#include "server/operations/metrics.h"

namespace lightwell {

/// Thread-safe: several threads may do the same work.
class BackgroundTask {
 public:
  /// `name` is the task in the log and in the metrics, which outlive it.
  BackgroundTask(std::string name, Metrics& metrics) : name_(std::move(name)), metrics_(metrics) {}

  /// Does the work. False if it threw: every time that is counted, and logged when it begins; so is that it is over.
  bool attempt(const std::function<void()>& work) {
    try {
      work();
    } catch (const std::exception& error) {
      failed(error.what());
      return false;
    }
    worked();
    return true;
  }

 private:
  void failed(const std::string& reason);
  void worked();

  const std::string name_;
  Metrics& metrics_;
  std::atomic<bool> fails_ = false;
};

}  // namespace lightwell
