// Holds a frame rate: how many samples and how large an indirect map the times of the frames before allow.
#pragma once

#include <cstdint>

#include "renderer/renderer.h"

namespace lightwell {

class FrameBudget {
 public:
  /// What a frame is to be made with: `wanted`, or less of samples and indirect_size where Settings::target_fps asks
  /// for it.
  Settings within(const Settings& wanted);

  /// What the last frame took: all of it, and of that the part which grows with the rays, in milliseconds.
  void note(double total_ms, double of_rays_ms);

  /// Steps of quality given up; 0: none.
  int level() const { return level_; }

 private:
  double predicted_ms(int level) const;

  Settings wanted_;
  int level_ = 0;
  int frames_ = 0;                            // at this level
  int calm_frames_ = 0;                       // in a row in which the next better level would have fit
  double total_ms_ = 0.0, of_rays_ms_ = 0.0;  // means over late frames
};

}  // namespace lightwell
