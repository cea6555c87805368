#include "server/stream/picture_grade.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwell {
namespace {

struct Step {
  int quality_percent;  // of the full quality
  double scale;
};
constexpr std::array<Step, 8> kSteps{
    {{100, 1.0}, {85, 1.0}, {70, 1.0}, {55, 1.0}, {55, 0.75}, {55, 0.5}, {50, 0.35}, {50, 0.25}}};

constexpr double kMemory = 0.7;        // of the sizes before the last one
constexpr double kBackUpBelow = 0.75;  // of the budget: less is given up again only with room to spare
// A moving picture that takes longer to render than this gives up resolution. On a link with a delay it is less: an
// input waits for one picture, is rendered in the next, and is to be seen in time.
constexpr double kSlowRenderS = 0.15, kLeastSlowRenderS = 0.06, kInTimeS = 0.35;
constexpr double kWantedShare = 0.8;  // of that: then it takes no longer,
constexpr double kQuickShare = 0.7;   // and gets resolution back when it would take less than this at the next step up
constexpr double kLeastRenderScale = 0.5;
constexpr double kRenderScaleStep = 1.25;
constexpr double kShareOfLink = 0.8;

/// Bytes of a JPEG file at a quality against those at 80; measured on rendered scenes at 512 x 512.
double relative_bytes(double quality) {
  constexpr std::array<std::pair<double, double>, 7> kTable{
      {{20, 0.31}, {40, 0.50}, {60, 0.68}, {80, 1.0}, {90, 1.5}, {95, 2.2}, {100, 4.5}}};
  const auto above =
      std::find_if(kTable.begin(), kTable.end(), [&](const auto& entry) { return entry.first >= quality; });
  if (above == kTable.begin()) return kTable.front().second;
  if (above == kTable.end()) return kTable.back().second;
  const auto& [low, low_bytes] = *std::prev(above);
  return std::lerp(low_bytes, above->second, (quality - low) / (above->first - low));
}

}  // namespace

glm::ivec2 PictureGrade::scaled(glm::ivec2 size_px) const {
  const auto side = [this](int full) {
    if (scale >= 1.0 || full <= 16) return full;
    return std::clamp(2 * static_cast<int>(std::lround(full * scale / 2.0)), 16, full);
  };
  return {side(size_px.x), side(size_px.y)};
}

void PictureGrader::made(const PictureGrade& grade, double bytes, double render_s) {
  const double area = grade.scale * grade.scale;
  const double share = area * relative_bytes(grade.quality) / relative_bytes(full_quality_);
  full_bytes_ = full_bytes_ > 0.0 ? std::lerp(bytes / share, full_bytes_, kMemory) : bytes / share;
  render_cost_.rendered(area, render_s);
}

int PictureGrader::level_for(double budget_bytes) const {
  const double full = relative_bytes(full_quality_);
  int level = 0;
  for (; level + 1 < static_cast<int>(kSteps.size()); ++level) {
    const Step& step = kSteps[static_cast<std::size_t>(level)];
    const double quality = full_quality_ * step.quality_percent / 100.0;
    const double bytes = full_bytes_ * step.scale * step.scale * relative_bytes(quality) / full;
    if (bytes <= budget_bytes * (level < level_ ? kBackUpBelow : 1.0)) break;
  }
  return level;
}

double PictureGrader::scale_for_rendering(double delay_s) const {
  const double slow_s = std::clamp((kInTimeS - delay_s) / 2.0, kLeastSlowRenderS, kSlowRenderS);
  if (render_cost_.seconds_at(render_scale_ * render_scale_) > slow_s) {
    const double area = render_cost_.area_for(kWantedShare * slow_s);
    return std::clamp(std::sqrt(std::max(area, 0.0)), kLeastRenderScale, render_scale_);
  }
  const double next = std::min(render_scale_ * kRenderScaleStep, 1.0);
  return render_cost_.seconds_at(next * next) < kQuickShare * slow_s ? next : render_scale_;
}

PictureGrade PictureGrader::choose(const LinkPace& pace) {
  level_ = level_for(pace.budget_bytes());
  render_scale_ = scale_for_rendering(pace.least_delay_s());
  const Step& step = kSteps[static_cast<std::size_t>(level_)];
  PictureGrade grade;
  grade.quality = std::max(static_cast<int>(std::lround(full_quality_ * step.quality_percent / 100.0)), 1);
  grade.scale = std::min(step.scale, render_scale_);
  const bool all_given_up = level_ + 1 == static_cast<int>(kSteps.size());
  const double bytes_per_s = pace.bytes_per_s();
  if (all_given_up && bytes_per_s > 0.0) {
    const double share = grade.scale * grade.scale * relative_bytes(grade.quality) / relative_bytes(full_quality_);
    const double seconds = full_bytes_ * share / (bytes_per_s * kShareOfLink);
    grade.interval = std::chrono::microseconds(std::llround(std::min(seconds, 2.0) * 1e6));
  }
  return grade;
}

}  // namespace lightwell
