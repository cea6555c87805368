#include "server/command_line/thesis/measurement.h"

#include <algorithm>

#include "renderer/check.h"
#include "renderer/renderer.h"

namespace lightwell {

namespace {

template <class Value>
Value median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double ms_of_stage(const FrameCost& frame, const std::string& name) {
  for (const StageCost& stage : frame.stages)
    if (stage.name == name) return stage.ms;
  return 0.0;
}

double per_second(double count, double ms) {
  return ms > 0.0 ? 1000.0 * count / ms : 0.0;
}

}  // namespace

FrameCost cost_of(const Frame& frame) {
  FrameCost cost{frame.total_ms, {}, frame.rays};
  for (const StageTime& stage : frame.stages) cost.stages.push_back({std::string(stage.name), stage.ms});
  return cost;
}

FrameCost median_cost(const std::vector<FrameCost>& frames) {
  LIGHTWELL_CHECK_OP(frames.size(), >, 0u);
  const auto median_of = [&](auto value) {
    std::vector<decltype(value(frames.front()))> values;
    for (const FrameCost& frame : frames) values.push_back(value(frame));
    return median(std::move(values));
  };
  FrameCost middle;
  middle.ms = median_of([](const FrameCost& frame) { return frame.ms; });
  middle.rays = median_of([](const FrameCost& frame) { return frame.rays; });
  for (const FrameCost& frame : frames)
    for (const StageCost& stage : frame.stages) {
      const auto known = [&](const StageCost& other) { return other.name == stage.name; };
      if (std::any_of(middle.stages.begin(), middle.stages.end(), known)) continue;
      middle.stages.push_back({stage.name, median_of([&](const FrameCost& f) { return ms_of_stage(f, stage.name); })});
    }
  return middle;
}

double moment_s(int frame, double duration_s) {
  double phase = 0.0, digit = 0.5;
  for (int n = frame; n > 0; n /= 2, digit *= 0.5) phase += digit * (n % 2);
  return phase * duration_s;
}

double tracing_ms(const FrameCost& cost) {
  return ms_of_stage(cost, "trace") + ms_of_stage(cost, "candidates");
}

double MeasuredRow::rays_resolved_per_s() const {
  return per_second(static_cast<double>(indirect_side_px) * indirect_side_px * printed.samples, median.ms);
}

double MeasuredRow::rays_traced_per_s() const {
  return per_second(static_cast<double>(median.rays), median.ms);
}

double MeasuredTerrain::rays_traced_per_s() const {
  return per_second(static_cast<double>(median.rays), median.ms);
}

}  // namespace lightwell
