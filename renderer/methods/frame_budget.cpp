#include "renderer/methods/frame_budget.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

namespace {

constexpr int kFewestSamples = 16;   // one ray a frame and texel, see kFramesOfSamples of the method
constexpr int kSmallestMap_px = 32;  // or what is wanted, if that is less
constexpr double kSmallerSide = 0.75;
constexpr int kMostLevels = 32;
constexpr int kFramesToJudge = 4;   // the first at a level may compile shaders and have no history yet
constexpr int kFramesToTrust = 24;  // that there is room for more
constexpr double kRoom = 0.85;      // of the budget, for a better level to be tried
constexpr double kWeightOfLate = 0.25;

struct Quality {
  int samples, indirect_size;
};

// Samples first: the history makes up for them. A new size of the map forgets it.
Quality quality_at(const Settings& wanted, int level) {
  Quality quality{wanted.samples, wanted.indirect_size};
  const int smallest_px = std::min(kSmallestMap_px, wanted.indirect_size);
  for (int i = 0; i < level; ++i) {
    if (quality.samples > kFewestSamples)
      quality.samples = std::max(quality.samples / 2, kFewestSamples);
    else
      quality.indirect_size = std::max(static_cast<int>(quality.indirect_size * kSmallerSide), smallest_px);
  }
  return quality;
}

bool is_same(const Quality& a, const Quality& b) {
  return a.samples == b.samples && a.indirect_size == b.indirect_size;
}

// Rays of a frame, in any unit.
double rays_of(const Quality& quality) {
  const double texels = static_cast<double>(quality.indirect_size) * quality.indirect_size;
  return texels * std::max(1, quality.samples / kFewestSamples);
}

}  // namespace

Settings FrameBudget::within(const Settings& wanted) {
  const bool same = wanted.target_fps == wanted_.target_fps && wanted.samples == wanted_.samples &&
                    wanted.indirect_size == wanted_.indirect_size;
  wanted_ = wanted;
  if (!same || wanted.target_fps == 0) {
    level_ = frames_ = calm_frames_ = 0;
    if (wanted.target_fps == 0) return wanted;
  }
  const Quality quality = quality_at(wanted, level_);
  Settings settings = wanted;
  settings.samples = quality.samples;
  settings.indirect_size = quality.indirect_size;
  return settings;
}

// At another level the part that grows with the rays is taken to follow them.
double FrameBudget::predicted_ms(int level) const {
  const double now = rays_of(quality_at(wanted_, level_));
  return total_ms_ - of_rays_ms_ + of_rays_ms_ * rays_of(quality_at(wanted_, level)) / now;
}

void FrameBudget::note(double total_ms, double of_rays_ms) {
  if (wanted_.target_fps == 0) return;
  ++frames_;
  const double share = frames_ <= 2 ? 1.0 : kWeightOfLate;  // the first frame of a level tells little
  total_ms_ += share * (total_ms - total_ms_);
  of_rays_ms_ += share * (of_rays_ms - of_rays_ms_);
  if (frames_ < kFramesToJudge) return;
  const double budget_ms = 1000.0 / wanted_.target_fps;
  int next = level_;
  if (total_ms_ > budget_ms) {
    calm_frames_ = 0;
    // The best level that fits; where none does, the last that makes a difference.
    while (next < kMostLevels && predicted_ms(next) > budget_ms &&
           !is_same(quality_at(wanted_, next), quality_at(wanted_, next + 1)))
      ++next;
  } else if (level_ > 0) {
    calm_frames_ = predicted_ms(level_ - 1) < kRoom * budget_ms ? calm_frames_ + 1 : 0;
    if (calm_frames_ >= kFramesToTrust) --next;
  }
  if (next == level_) return;
  level_ = next;
  frames_ = calm_frames_ = 0;
}

}  // namespace lightwell
