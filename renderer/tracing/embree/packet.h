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
  const __m128 farthest = _mm_set1_ps(1e18f), sign = _mm_set1_ps(-0.0f);
  const auto within = [&](const glm::vec3& v) {  // with what follows it in the record, a bit each
    return _mm_movemask_ps(_mm_cmple_ps(_mm_andnot_ps(sign, _mm_loadu_ps(&v.x)), farthest));
  };
  constexpr int kVector = 7;
  return (ray.t_max >= ray.t_min) & ((within(ray.origin_ws) & within(ray.direction_ws) & kVector) == kVector);
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
  Packet() { std::fill(std::begin(packet_.ray.mask), std::end(packet_.ray.mask), ~0u); }

  bool is_full() const { return size_ == width; }
  bool is_empty() const { return size_ == 0; }
  int size() const { return size_; }
  std::uint32_t ray(int lane) const { return indices_[static_cast<std::size_t>(lane)]; }

  void add(const Ray& ray, std::uint32_t index) {
    const auto lane = static_cast<std::size_t>(size_++);
    rays_[lane] = ray;
    indices_[lane] = index;
  }
  void clear() { size_ = 0; }

  void intersect(const EmbreeScene& scene) {
    load();
    std::fill(std::begin(packet_.hit.geomID), std::end(packet_.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    std::fill(std::begin(packet_.hit.instID[0]), std::end(packet_.hit.instID[0]), RTC_INVALID_GEOMETRY_ID);
    EmbreeContext context = context_for(scene);
    PacketTypes<width>::kIntersect(valid_, scene.top_level(), &context.embree, &packet_);
  }
  void occlude(const EmbreeScene& scene) {
    load();
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
  // pixels, and of 1.5 for diffuse rays and for parallel ones from scattered points. Scattered is what is many
  // triangles apart: each ray then ends in leaves of its own.
  EmbreeContext context_for(const EmbreeScene& scene) const {
    EmbreeContext context;
    rtcInitIntersectContext(&context.embree);
    context.embree.flags = rays_stay_together(scene.triangle_size_m()) ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                                       : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    context.scene = &scene;
    return context;
  }

  // Four rays at a time from records to lanes; lanes beyond the last ray repeat the first.
  void load() {
    auto& r = packet_.ray;
    const __m128 zero = _mm_setzero_ps();
    for (int first = 0; first < width; first += 4) {
      __m128 origin[4], direction[4];
      for (int i = 0; i < 4; ++i) {
        const Ray& ray = rays_[static_cast<std::size_t>(first + i < size_ ? first + i : 0)];
        origin[i] = _mm_loadu_ps(&ray.origin_ws.x);
        direction[i] = _mm_loadu_ps(&ray.direction_ws.x);
        valid_[first + i] = first + i < size_ ? -1 : 0;
      }
      _MM_TRANSPOSE4_PS(origin[0], origin[1], origin[2], origin[3]);
      _MM_TRANSPOSE4_PS(direction[0], direction[1], direction[2], direction[3]);
      _mm_store_ps(r.org_x + first, origin[0]), _mm_store_ps(r.org_y + first, origin[1]);
      _mm_store_ps(r.org_z + first, origin[2]), _mm_store_ps(r.tnear + first, _mm_max_ps(origin[3], zero));
      _mm_store_ps(r.dir_x + first, direction[0]), _mm_store_ps(r.dir_y + first, direction[1]);
      _mm_store_ps(r.dir_z + first, direction[2]), _mm_store_ps(r.tfar + first, direction[3]);
    }
  }

  bool rays_stay_together(float triangle_size_m) const {
    constexpr float kLeastCosine = 0.9f, kMostSpread = 8.0f;  // triangles
    const auto& r = packet_.ray;
    const auto differences = [](const float* values, int first) {
      return _mm_sub_ps(_mm_load_ps(values + first), _mm_set1_ps(values[0]));
    };
    const auto products = [](const float* values, int first) {
      return _mm_mul_ps(_mm_load_ps(values + first), _mm_set1_ps(values[0]));
    };
    const __m128 sign = _mm_set1_ps(-0.0f);
    int together = 0xf;
    for (int i = 0; i < width; i += 4) {
      const __m128 cosine = _mm_add_ps(_mm_add_ps(products(r.dir_x, i), products(r.dir_y, i)), products(r.dir_z, i));
      const __m128 spread = _mm_add_ps(
          _mm_add_ps(_mm_andnot_ps(sign, differences(r.org_x, i)), _mm_andnot_ps(sign, differences(r.org_y, i))),
          _mm_andnot_ps(sign, differences(r.org_z, i)));
      together &= _mm_movemask_ps(_mm_and_ps(_mm_cmpgt_ps(cosine, _mm_set1_ps(kLeastCosine)),
                                             _mm_cmple_ps(spread, _mm_set1_ps(kMostSpread * triangle_size_m))));
    }
    return together == 0xf;
  }

  alignas(64) int valid_[width] = {};
  alignas(64) typename PacketTypes<width>::RayHit packet_ = {};
  std::array<Ray, width> rays_;
  std::array<std::uint32_t, width> indices_ = {};
  int size_ = 0;
};

/// A HitList being filled by several threads, each of which gathers the hits of a chunk before it takes room for them.
class HitListWriter {
 public:
  explicit HitListWriter(std::uint32_t* rays) : rays_(rays) {}
  void add(std::span<const std::uint32_t> hits) {
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
