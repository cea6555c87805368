// Rays in the vectors that Embree takes, and what threads need while they trace them.
#pragma once

#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "renderer/tracing/embree/embree_scene.h"

namespace lightwell {

/// Denormal numbers are flushed to zero while tracing: Embree's arithmetic is many times slower on them.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

/// False for an inactive ray and for one that is not finite, as a degenerate camera makes them: over such a ray Embree
/// ends the process.
inline bool is_active(const Ray& ray) {
  constexpr float kFarthest = 1e18f;
  const glm::vec3 origin = glm::abs(ray.origin_ws), direction = glm::abs(ray.direction_ws);
  const auto is_within = [](float x) { return x <= kFarthest; };
  return (ray.t_max >= ray.t_min) & is_within(origin.x) & is_within(origin.y) & is_within(origin.z) &
         is_within(direction.x) & is_within(direction.y) & is_within(direction.z);
}

template <int width>
struct PacketTypes;
template <>
struct PacketTypes<4> {
  using RayHit = RTCRayHit4;
  static constexpr auto kIntersect = rtcIntersect4;
  static constexpr auto kOccluded = rtcOccluded4;
};
template <>
struct PacketTypes<8> {
  using RayHit = RTCRayHit8;
  static constexpr auto kIntersect = rtcIntersect8;
  static constexpr auto kOccluded = rtcOccluded8;
};
template <>
struct PacketTypes<16> {
  using RayHit = RTCRayHit16;
  static constexpr auto kIntersect = rtcIntersect16;
  static constexpr auto kOccluded = rtcOccluded16;
};

/// Active rays gathered until they fill the vector unit.
template <int width>
class Packet {
 public:
  bool is_full() const { return size_ == width; }
  bool is_empty() const { return size_ == 0; }
  int size() const { return size_; }
  std::uint32_t ray(int lane) const { return rays_[static_cast<std::size_t>(lane)]; }

  void add(const Ray& ray, std::uint32_t index) {
    const int i = size_++;
    rays_[static_cast<std::size_t>(i)] = index;
    valid_[i] = -1;
    auto& r = packet_.ray;
    r.org_x[i] = ray.origin_ws.x, r.org_y[i] = ray.origin_ws.y, r.org_z[i] = ray.origin_ws.z;
    r.dir_x[i] = ray.direction_ws.x, r.dir_y[i] = ray.direction_ws.y, r.dir_z[i] = ray.direction_ws.z;
    r.tnear[i] = std::max(ray.t_min, 0.0f);
    r.tfar[i] = ray.t_max;
    r.time[i] = 0.0f, r.mask[i] = ~0u, r.id[i] = 0, r.flags[i] = 0;
    packet_.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet_.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }

  void clear() {
    size_ = 0;
    std::fill(std::begin(valid_), std::end(valid_), 0);
  }

  void intersect(const EmbreeScene& scene) {
    EmbreeContext context = context_for(scene);
    PacketTypes<width>::kIntersect(valid_, scene.top_level(), &context.embree, &packet_);
  }
  void occlude(const EmbreeScene& scene) {
    EmbreeContext context = context_for(scene);
    PacketTypes<width>::kOccluded(valid_, scene.top_level(), &context.embree, &packet_.ray);
  }

  Hit hit(int i, const EmbreeScene& scene) const {
    const auto& h = packet_.hit;
    if (h.geomID[i] == RTC_INVALID_GEOMETRY_ID) return {kMiss, 0, 0, 0.0f, 0.0f};
    return {packet_.ray.tfar[i], scene.instance_of(h.instID[0][i], h.geomID[i]), h.primID[i], h.u[i], h.v[i]};
  }
  bool is_occluded(int i) const { return packet_.ray.tfar[i] == -std::numeric_limits<float>::infinity(); }

 private:
  // Embree walks the tree with the packet as one where it is told that the rays stay together, else ray by ray.
  // Measured with 8 lanes: the right choice is worth a factor of 1.5 to 3 for primary and shadow rays of neighbouring
  // pixels, and of 1.5 for diffuse rays and for parallel ones from scattered points.
  EmbreeContext context_for(const EmbreeScene& scene) const {
    EmbreeContext context;
    rtcInitIntersectContext(&context.embree);
    context.embree.flags = rays_stay_together(scene.diagonal_m()) ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                                  : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    context.scene = &scene;
    return context;
  }

  bool rays_stay_together(float diagonal_m) const {
    constexpr float kLeastCosine = 0.9f, kMostSpread = 0.03f;  // of the scene's diagonal
    const auto& r = packet_.ray;
    float least_cosine = 1.0f, greatest_spread = 0.0f;
    for (int i = 1; i < size_; ++i) {
      const float cosine = r.dir_x[0] * r.dir_x[i] + r.dir_y[0] * r.dir_y[i] + r.dir_z[0] * r.dir_z[i];
      const float spread =
          std::abs(r.org_x[0] - r.org_x[i]) + std::abs(r.org_y[0] - r.org_y[i]) + std::abs(r.org_z[0] - r.org_z[i]);
      least_cosine = std::min(least_cosine, cosine);
      greatest_spread = std::max(greatest_spread, spread);
    }
    return least_cosine > kLeastCosine && greatest_spread <= kMostSpread * diagonal_m;
  }

  alignas(64) int valid_[width] = {};
  alignas(64) typename PacketTypes<width>::RayHit packet_ = {};
  std::array<std::uint32_t, width> rays_ = {};
  int size_ = 0;
};

/// A HitList being filled by several threads, each of which gathers the hits of a chunk before it takes room for them.
class HitListWriter {
 public:
  explicit HitListWriter(std::uint32_t* rays) : rays_(rays) {}
  void add(std::span<const std::uint32_t> hits) {
    if (rays_ != nullptr)
      std::copy(hits.begin(), hits.end(), rays_ + count_.fetch_add(static_cast<std::uint32_t>(hits.size())));
  }
  std::uint32_t count() const { return count_; }

  void count_traced_anew(int rays) { traced_anew_ += static_cast<std::uint32_t>(rays); }
  std::uint32_t traced_anew() const { return traced_anew_; }

 private:
  std::uint32_t* rays_;
  std::atomic<std::uint32_t> count_ = 0, traced_anew_ = 0;
};

}  // namespace lightwell
