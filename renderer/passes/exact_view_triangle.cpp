#include "renderer/passes/exact_view_triangle.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace lightwell {
namespace {

constexpr double kReach_px = 1e-3;  // over an edge: the neighbour's may be a float's rounding away

glm::dvec3 vector(const float (&values)[3]) {
  return {values[0], values[1], values[2]};
}

// The depth of lanes::ViewTarget, and the square of its slope, from t and how that changes from pixel to pixel.
std::array<double, 2> depth_of(const lanes::ViewTarget& target, glm::dvec2 pixel, double t, glm::dvec2 slope) {
  if (!target.as_depths) return {t, 0.0};
  double depth = t;
  if (target.as_distance) {
    const glm::dvec3 across = vector(target.across_ws), down = vector(target.down_ws);
    const glm::dvec3 direction = vector(target.direction_ws) + pixel.x * across + pixel.y * down;
    const double distance = glm::length(direction);
    depth = t * distance;
    slope = slope * distance + t / distance * glm::dvec2(glm::dot(direction, across), glm::dot(direction, down));
  }
  slope *= static_cast<double>(target.factor);
  return {depth * static_cast<double>(target.factor), glm::dot(slope, slope)};
}

}  // namespace

ExactViewTriangle::ExactViewTriangle(const std::array<glm::dvec3, 3>& corners, double front, std::uint32_t number,
                                     const lanes::ViewTarget& target)
    : number_(number) {
  std::array<glm::dvec3, 3> at = corners;
  if (!target.is_perspective)
    for (glm::dvec3& corner : at) corner.z = 1.0;
  const double volume = glm::dot(at[0], glm::cross(at[1], at[2]));
  if (!std::isnormal(volume) || volume * front < 0.0) return;
  for (std::size_t i = 0; i < 3; ++i) {
    edges_[i] = glm::cross(at[(i + 1) % 3], at[(i + 2) % 3]) / volume;
    pixels_[i] = glm::length(glm::dvec2(edges_[i]));
    q_ += edges_[i] * (target.is_perspective ? 1.0 : corners[i].z);
  }
  find_bounds(corners, target);
}

// Around the part before the eye.
void ExactViewTriangle::find_bounds(const std::array<glm::dvec3, 3>& corners, const lanes::ViewTarget& target) {
  const double near = target.t_min;
  glm::dvec2 least(1e300), greatest(-1e300);
  const auto add = [&](const glm::dvec3& corner) {
    const glm::dvec2 pixel = target.is_perspective ? glm::dvec2(corner) / corner.z : glm::dvec2(corner);
    least = glm::min(least, pixel), greatest = glm::max(greatest, pixel);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % 3];
    if (!target.is_perspective || a.z >= near) add(a);
    if (target.is_perspective && (a.z < near) != (b.z < near)) {
      const double share = (near - a.z) / (b.z - a.z);
      add({glm::mix(glm::dvec2(a), glm::dvec2(b), share), near});
    }
  }
  const glm::dvec2 size(target.width_px, target.height_px);
  if (!(least.x <= greatest.x && least.y <= greatest.y)) return;
  first_px_ = glm::ivec2(glm::ceil(glm::clamp(least - kReach_px, glm::dvec2(0.0), size)));
  end_px_ = glm::ivec2(glm::floor(glm::clamp(greatest + kReach_px, glm::dvec2(-1.0), size - 1.0))) + 1;
}

void ExactViewTriangle::draw(const lanes::ViewTarget& target, int begin, int end) const {
  for (int y = std::max(begin, first_px_.y); y < std::min(end, end_px_.y); ++y)
    for (int x = first_px_.x; x < end_px_.x; ++x) draw_pixel(target, x, y);
}

void ExactViewTriangle::draw_pixel(const lanes::ViewTarget& target, int x, int y) const {
  const glm::dvec3 pixel(x, y, 1.0);
  for (std::size_t i = 0; i < 3; ++i)
    if (!(glm::dot(edges_[i], pixel) >= -kReach_px * pixels_[i])) return;
  const double q = glm::dot(q_, pixel);
  const double t = target.is_perspective ? 1.0 / q : q;
  if (!(t >= static_cast<double>(target.t_min) && t <= static_cast<double>(target.t_max))) return;
  const glm::dvec2 slope = glm::dvec2(q_) * (target.is_perspective ? -t * t : 1.0);
  const auto [depth, slope2] = depth_of(target, pixel, t, slope);
  const std::uint32_t low = target.as_depths ? std::bit_cast<std::uint32_t>(static_cast<float>(slope2)) : number_;
  const std::uint64_t seen =
      std::uint64_t{std::bit_cast<std::uint32_t>(std::max(static_cast<float>(depth), 0.0f))} << 32 | low;
  std::atomic_ref<std::uint64_t> kept(target.nearest[static_cast<std::ptrdiff_t>(y) * target.width_px + x]);
  std::uint64_t before = kept.load(std::memory_order_relaxed);
  while (seen < before && !kept.compare_exchange_weak(before, seen, std::memory_order_relaxed)) {
  }
}

}  // namespace lightwell
