#include "renderer/methods/frame_budget.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

namespace {

constexpr int kSamplesOfRay = 16;    // of one ray a frame and texel, see kFramesOfSamples of the method
constexpr int kSamplesOfPairs = 8;   // of one a frame and patch of two texels
constexpr int kFewestSamples = 4;    // of one a frame and patch of four
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

// By how much is lost for the time. Samples first, for the history makes up for them. Patches of two texels that share
// a ray lose as much for the time as a smaller map, which forgets the history as well. Patches of four save little
// more, for what goes with the texels stays: last.
Quality quality_at(const Settings& wanted, int level) {
  Quality quality{wanted.samples, wanted.indirect_size};
  const int smallest_px = std::min(kSmallestMap_px, wanted.indirect_size);
  for (int i = 0; i < level; ++i) {
    if (quality.samples > kSamplesOfRay)
      quality.samples = std::max(quality.samples / 2, kSamplesOfRay);
    else if (quality.samples > kSamplesOfPairs)
      quality.samples = kSamplesOfPairs;
    else if (quality.indirect_size > smallest_px)
      quality.indirect_size = std::max(static_cast<int>(quality.indirect_size * kSmallerSide), smallest_px);
    else
      quality.samples = std::min(quality.samples, kFewestSamples);
  }
  return quality;
}

bool is_same(const Quality& a, const Quality& b) {
  return a.samples == b.samples && a.indirect_size == b.indirect_size;
}

double texels_of(const Quality& quality) {
  return static_cast<double>(quality.indirect_size) * quality.indirect_size;
}

// Rays of a frame, in any unit.
double rays_of(const Quality& quality) {
  const double of_texel = quality.samples > kSamplesOfPairs  ? std::max(1, quality.samples / kSamplesOfRay)
                          : quality.samples > kFewestSamples ? 0.5
                                                             : 0.25;
  return texels_of(quality) * of_texel;
}

void take_in(double& mean, double value, double share) {
  mean += share * (value - mean);
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

// At another level the parts that grow with rays and texels are taken to follow them.
double FrameBudget::predicted_ms(int level) const {
  const Quality now = quality_at(wanted_, level_), then = quality_at(wanted_, level);
  return mean_.total_ms + mean_.of_rays_ms * (rays_of(then) / rays_of(now) - 1.0) +
         mean_.of_map_ms * (texels_of(then) / texels_of(now) - 1.0);
}

void FrameBudget::note(const FrameTimes& times) {
  if (wanted_.target_fps == 0) return;
  ++frames_;
  const double share = frames_ <= 2 ? 1.0 : kWeightOfLate;  // the first frame of a level tells little
  take_in(mean_.total_ms, times.total_ms, share);
  take_in(mean_.of_rays_ms, times.of_rays_ms, share);
  take_in(mean_.of_map_ms, times.of_map_ms, share);
  if (frames_ < kFramesToJudge) return;
  const double budget_ms = 1000.0 / wanted_.target_fps;
  int next = level_;
  if (mean_.total_ms > budget_ms) {
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
