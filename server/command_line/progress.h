// How far long work is, for people who wait.
#pragma once

#include <chrono>
#include <string>

namespace lightwell {

/// Writes to stderr: one line that is rewritten on a terminal, elsewhere a line a second at most.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const std::string& text);

  /// Takes the line off the terminal again, so that something else can be printed.
  void clear();

 private:
  bool terminal_ = false;
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace lightwell
