#include "server/sequences/keyframes.h"

#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

using protocol::Keyframes;
using protocol::KeyInterpolation;
using Values = std::vector<double>;

bool is_rotation(const Keyframes& keyframes) {
  return keyframes.path.ends_with("/rotation") && keyframes.values.front().size() == 4;
}

double dot(const Values& a, const Values& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

Values normalized(Values value) {
  const double length = std::sqrt(dot(value, value));
  if (length > 0.0)
    for (double& component : value) component /= length;
  return value;
}

Values mixed(const Values& a, double weight_a, const Values& b, double weight_b) {
  Values sum(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] = weight_a * a[i] + weight_b * b[i];
  return sum;
}

/// Spherical linear interpolation along the shorter arc.
Values slerp(const Values& from, const Values& to, double share) {
  const Values a = normalized(from), b = normalized(to);
  const double cosine = dot(a, b);
  const double sign = cosine < 0.0 ? -1.0 : 1.0;
  const double angle = std::acos(std::min(std::abs(cosine), 1.0));
  if (angle < 1e-6) return normalized(mixed(a, 1.0 - share, b, sign * share));
  const double sine = std::sin(angle);
  return normalized(mixed(a, std::sin((1.0 - share) * angle) / sine, b, sign * std::sin(share * angle) / sine));
}

/// Cubic Hermite between keys `i` and `i + 1`, `span_s` apart. A key is in-tangent, value, out-tangent.
Values hermite(const Keyframes& keyframes, std::size_t i, double share, double span_s) {
  const double t = share, t2 = t * t, t3 = t2 * t;
  const Values points =
      mixed(keyframes.values[3 * i + 1], 2 * t3 - 3 * t2 + 1, keyframes.values[3 * i + 4], 3 * t2 - 2 * t3);
  const Values tangents =
      mixed(keyframes.values[3 * i + 2], span_s * (t3 - 2 * t2 + t), keyframes.values[3 * i + 3], span_s * (t3 - t2));
  return mixed(points, 1.0, tangents, 1.0);
}

}  // namespace

Values value_at(const Keyframes& keyframes, double time_s) {
  const std::vector<double>& times = keyframes.times_s;
  const bool spline = keyframes.interpolation == KeyInterpolation::kCubicSpline;
  const auto key = [&](std::size_t i) { return keyframes.values[spline ? 3 * i + 1 : i]; };
  const auto finish = [&](Values value) { return is_rotation(keyframes) ? normalized(std::move(value)) : value; };
  const auto after = std::upper_bound(times.begin(), times.end(), time_s);
  if (after == times.begin()) return finish(key(0));
  const auto i = static_cast<std::size_t>(after - times.begin()) - 1;
  if (after == times.end() || keyframes.interpolation == KeyInterpolation::kStep) return finish(key(i));
  const double span_s = times[i + 1] - times[i];
  const double share = (time_s - times[i]) / span_s;
  if (spline) return finish(hermite(keyframes, i, share, span_s));
  if (is_rotation(keyframes)) return slerp(key(i), key(i + 1), share);
  return mixed(key(i), 1.0 - share, key(i + 1), share);
}

protocol::Edits edits_at(const std::vector<Keyframes>& keyframes, double time_s) {
  protocol::Edits edits = protocol::Edits::array();
  for (const Keyframes& property : keyframes) {
    const Values value = value_at(property, time_s);
    nlohmann::json edit{{"op", "replace"}, {"path", property.path}};
    if (property.scalar)
      edit["value"] = value.front();
    else
      edit["value"] = value;
    edits.push_back(std::move(edit));
  }
  return edits;
}

protocol::FreeCamera camera_at(protocol::FreeCamera camera, const std::vector<Keyframes>& keyframes, double time_s) {
  for (const Keyframes& property : keyframes) {
    const Values value = value_at(property, time_s);
    if (property.path == "/yfov") {
      camera.yfov = std::clamp(value.front(), 1e-3, 3.14);
      continue;
    }
    std::copy_n(value.begin(), 3, (property.path == "/eye" ? camera.eye : camera.target).begin());
  }
  return camera;
}

}  // namespace lightwell
