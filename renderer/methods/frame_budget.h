// Holds a frame rate: how many samples, how large patches that share rays, and how large an indirect map the times of
// the frames before allow.
#pragma once

#include <cstdint>

#include "renderer/renderer.h"

namespace lightwell {

/// What a frame took, milliseconds: all of it, and of that the parts that grow with its rays and with the texels of the
/// indirect map.
struct FrameTimes {
  double total_ms = 0.0, of_rays_ms = 0.0, of_map_ms = 0.0;
};

class FrameBudget {
 public:
  /// What a frame is to be made with: `wanted`, or less of samples and indirect_size where Settings::target_fps asks
  /// for it; below 16 samples texels share a frame's rays.
  Settings within(const Settings& wanted);

  /// What the last frame took.
  void note(const FrameTimes& times);

  /// Steps of quality given up; 0: none.
  int level() const { return level_; }

 private:
  double predicted_ms(int level) const;

  Settings wanted_;
  int level_ = 0;
  int frames_ = 0;       // at this level
  int calm_frames_ = 0;  // in a row in which the next better level would have fit
  FrameTimes mean_;      // over late frames
};

}  // namespace lightwell
