// Time per stage of a frame. On a software device the work runs in this process, so a stage ends by waiting for it;
// on a GPU timestamps are queried and read when the frame is.
#pragma once

#include <chrono>
#include <functional>
#include <string_view>
#include <vector>

#include "renderer/gl/gl.h"

namespace lightwell::gl {

/// Thrown at the end of a stage: the frame is wanted no more.
struct FrameUnwanted {};

class StageTimer {
 public:
  struct Stage {
    std::string_view name;
    double ms = 0.0;
  };

  /// `software`: wait for the device at the end of every stage.
  explicit StageTimer(bool software) : software_(software) {}
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

  /// `is_unwanted` is asked at the end of every stage; may be empty.
  void begin_frame(std::function<bool()> is_unwanted);
  /// Everything issued since the last mark (or begin_frame) was the stage `name`. Equal names add up. Throws
  /// FrameUnwanted.
  void mark(std::string_view name);
  /// The stages since begin_frame; waits for the device.
  std::vector<Stage> end_frame();

 private:
  GLuint next_query();
  void note_end(std::string_view name);
  bool software_;
  std::function<bool()> is_unwanted_;
  std::chrono::steady_clock::time_point last_;
  std::vector<Stage> stages_;
  std::vector<GLuint> queries_;
  std::size_t used_queries_ = 0;
};

}  // namespace lightwell::gl
