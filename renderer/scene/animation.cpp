#include "renderer/scene/animation.h"

#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

/// Where a time lies among the keys: between `key` and `key + 1`, or on `key` when `span_s` is 0.
struct KeyInterval {
  std::size_t key = 0;
  float fraction = 0.0f;  // 0..1
  float span_s = 0.0f;
};

KeyInterval find_interval(std::span<const float> times_s, float time_s) {
  if (!(time_s > times_s.front())) return {};
  const auto next = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  if (next == times_s.end()) return {times_s.size() - 1, 0.0f, 0.0f};
  const float begin_s = *(next - 1);
  const float span_s = *next - begin_s;
  return {static_cast<std::size_t>(next - times_s.begin()) - 1, (time_s - begin_s) / span_s, span_s};
}

bool has_all_values(std::span<const float> times_s, std::span<const float> values, Interpolation interpolation,
                    std::size_t width) {
  const std::size_t per_key = interpolation == Interpolation::kCubicSpline ? 3 * width : width;
  return !times_s.empty() && width > 0 && values.size() / per_key >= times_s.size();
}

/// A key of a cubic spline is (in-tangent, value, out-tangent); tangents are per second.
void sample_cubic(const KeyInterval& at, std::span<const float> values, std::span<float> out) {
  const std::size_t width = out.size();
  const float* key = values.data() + at.key * 3 * width;
  if (at.span_s <= 0.0f) {
    std::copy_n(key + width, width, out.begin());
    return;
  }
  const float* next = key + 3 * width;
  const float t = at.fraction, t2 = t * t, t3 = t2 * t;
  const float from_value = 2 * t3 - 3 * t2 + 1, from_tangent = at.span_s * (t3 - 2 * t2 + t);
  const float to_value = -2 * t3 + 3 * t2, to_tangent = at.span_s * (t3 - t2);
  for (std::size_t i = 0; i < width; ++i)
    out[i] = from_value * key[width + i] + from_tangent * key[2 * width + i] + to_value * next[width + i] +
             to_tangent * next[i];
}

glm::quat normalised(glm::quat q) {
  const float length = glm::length(q);
  return length > 0.0f ? q / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
}

glm::quat quaternion_at(const float* xyzw) {
  return normalised(glm::quat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

}  // namespace

float local_time_s(double time_s, float duration_s) {
  if (!(time_s > 0.0) || !std::isfinite(time_s) || !(duration_s > 0.0f)) return 0.0f;
  return static_cast<float>(std::fmod(time_s, static_cast<double>(duration_s)));
}

bool sample_keyframes(std::span<const float> times_s, std::span<const float> values, Interpolation interpolation,
                      float time_s, std::span<float> out) {
  const std::size_t width = out.size();
  if (!has_all_values(times_s, values, interpolation, width)) return false;
  const KeyInterval at = find_interval(times_s, time_s);
  if (interpolation == Interpolation::kCubicSpline) {
    sample_cubic(at, values, out);
    return true;
  }
  const float* key = values.data() + at.key * width;
  std::copy_n(key, width, out.begin());
  if (interpolation == Interpolation::kLinear && at.span_s > 0.0f)
    for (std::size_t i = 0; i < width; ++i) out[i] += at.fraction * (key[width + i] - key[i]);
  return true;
}

bool sample_rotation(std::span<const float> times_s, std::span<const float> values, Interpolation interpolation,
                     float time_s, glm::quat& out) {
  if (interpolation != Interpolation::kLinear) {
    float xyzw[4];
    if (!sample_keyframes(times_s, values, interpolation, time_s, xyzw)) return false;
    out = quaternion_at(xyzw);
    return true;
  }
  if (!has_all_values(times_s, values, interpolation, 4)) return false;
  const KeyInterval at = find_interval(times_s, time_s);
  out = quaternion_at(values.data() + at.key * 4);
  if (at.span_s > 0.0f) {
    const glm::quat next = quaternion_at(values.data() + (at.key + 1) * 4);
    out = normalised(glm::slerp(out, next, at.fraction));  // GLM takes the shorter way
  }
  return true;
}

}  // namespace lightwell
