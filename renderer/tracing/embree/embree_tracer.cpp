#include "renderer/tracing/embree/embree_tracer.h"

#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "renderer/check.h"
#include "renderer/tracing/embree/embree_scene.h"
#include "renderer/tracing/thread_pool.h"

namespace lightwell {
namespace {

constexpr std::uint32_t kChunkRays = 1024;  // a multiple of 32, so that no two threads share a word of `visible`

// Denormal numbers are flushed to zero while tracing: Embree's arithmetic is many times slower on them.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

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

// Active rays gathered until they fill the vector unit.
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

bool is_active(const Ray& ray) {
  return ray.t_max >= ray.t_min;
}

// A HitList being filled by several threads, each of which gathers the hits of a chunk before it takes room for them.
class HitListWriter {
 public:
  explicit HitListWriter(std::uint32_t* rays) : rays_(rays) {}
  void add(std::span<const std::uint32_t> hits) {
    if (rays_ != nullptr)
      std::copy(hits.begin(), hits.end(), rays_ + count_.fetch_add(static_cast<std::uint32_t>(hits.size())));
  }
  std::uint32_t count() const { return count_; }

 private:
  std::uint32_t* rays_;
  std::atomic<std::uint32_t> count_ = 0;
};

template <int width>
void closest_hits(const EmbreeScene& scene, const Ray* rays, Hit* hits, HitListWriter& list, std::uint32_t begin,
                  std::uint32_t end) {
  const FlushDenormals flush;
  Packet<width> packet;
  std::array<std::uint32_t, kChunkRays> hit_rays;
  std::size_t hit_count = 0;
  const auto finish = [&] {
    packet.intersect(scene);
    for (int lane = 0; lane < packet.size(); ++lane) {
      const Hit hit = packet.hit(lane, scene);
      hits[packet.ray(lane)] = hit;
      hit_rays[hit_count] = packet.ray(lane);
      hit_count += hit.t >= 0.0f ? 1 : 0;
    }
    packet.clear();
  };
  for (std::uint32_t i = begin; i < end; ++i) {
    if (is_active(rays[i]))
      packet.add(rays[i], i);
    else
      hits[i] = {kMiss, 0, 0, 0.0f, 0.0f};
    if (packet.is_full()) finish();
  }
  if (!packet.is_empty()) finish();
  list.add(std::span(hit_rays).first(hit_count));
}

template <int width>
void any_hits(const EmbreeScene& scene, const Ray* rays, std::uint32_t* visible, std::uint32_t begin,
              std::uint32_t end) {
  const FlushDenormals flush;
  std::array<std::uint32_t, kChunkRays / 32> words = {};
  Packet<width> packet;
  const auto finish = [&] {
    packet.occlude(scene);
    for (int lane = 0; lane < packet.size(); ++lane) {
      const std::uint32_t i = packet.ray(lane) - begin;
      if (!packet.is_occluded(lane)) words[i / 32] |= 1u << (i % 32);
    }
    packet.clear();
  };
  for (std::uint32_t i = begin; i < end; ++i) {
    if (is_active(rays[i]))
      packet.add(rays[i], i);
    else
      words[(i - begin) / 32] |= 1u << ((i - begin) % 32);
    if (packet.is_full()) finish();
  }
  if (!packet.is_empty()) finish();
  std::copy_n(words.begin(), (end - begin + 31) / 32, visible + begin / 32);
}

class EmbreeTracer final : public Tracer {
 public:
  explicit EmbreeTracer(unsigned threads) : pool_(threads), scene_(threads) {
    if (rtcGetDeviceProperty(scene_.device(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0)
      width_ = 16;
    else if (rtcGetDeviceProperty(scene_.device(), RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0)
      width_ = 8;
  }

  std::string_view name() const override { return "embree"; }

  void update(const TraceScene& scene) override { scene_.update(scene); }

  void closest_hit(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits, HitList* list) override {
    LIGHTWELL_CHECK_OP(std::uint64_t{count} * sizeof(Hit), <=, hits.size_bytes());
    const Ray* in = rays_of(rays, count);
    Hit* out = host_of<Hit>(hits);
    HitListWriter writer(list ? host_of<std::uint32_t>(list->rays) : nullptr);
    gl::wait_for_device();
    pool_.parallel_for(count, kChunkRays, [&](std::uint32_t begin, std::uint32_t end) {
      if (width_ == 16)
        closest_hits<16>(scene_, in, out, writer, begin, end);
      else if (width_ == 8)
        closest_hits<8>(scene_, in, out, writer, begin, end);
      else
        closest_hits<4>(scene_, in, out, writer, begin, end);
    });
    if (!list) return;
    const std::uint32_t hit_count = writer.count();
    std::uint32_t* dispatch = host_of<std::uint32_t>(list->dispatch);
    dispatch[0] = (hit_count + kHitGroup - 1) / kHitGroup;
    dispatch[1] = dispatch[2] = 1;
    dispatch[3] = hit_count;
  }

  void any_hit(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& visible) override {
    LIGHTWELL_CHECK_OP((std::uint64_t{count} + 31) / 32 * sizeof(std::uint32_t), <=, visible.size_bytes());
    const Ray* in = rays_of(rays, count);
    std::uint32_t* out = host_of<std::uint32_t>(visible);
    if (count == 0) return;
    gl::wait_for_device();
    pool_.parallel_for(count, kChunkRays, [&](std::uint32_t begin, std::uint32_t end) {
      if (width_ == 16)
        any_hits<16>(scene_, in, out, begin, end);
      else if (width_ == 8)
        any_hits<8>(scene_, in, out, begin, end);
      else
        any_hits<4>(scene_, in, out, begin, end);
    });
  }

  std::uint64_t memory_bytes() const override { return scene_.memory_bytes(); }

 private:
  template <class T>
  static T* host_of(gl::Buffer& buffer) {
    LIGHTWELL_CHECK(buffer.host() != nullptr);
    return reinterpret_cast<T*>(buffer.host());
  }
  static const Ray* rays_of(const gl::Buffer& rays, std::uint32_t count) {
    LIGHTWELL_CHECK(rays.host() != nullptr);
    LIGHTWELL_CHECK_OP(std::uint64_t{count} * sizeof(Ray), <=, rays.size_bytes());
    return reinterpret_cast<const Ray*>(rays.host());
  }

  ThreadPool pool_;
  EmbreeScene scene_;
  int width_ = 4;
};

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(unsigned threads) {
  return std::make_unique<EmbreeTracer>(threads);
}

}  // namespace lightwell
