#include "renderer/tracing/embree/embree_tracer.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include "renderer/check.h"
#include "renderer/tracing/compact_scene.h"
#include "renderer/tracing/embree/candidates.h"
#include "renderer/tracing/embree/embree_bvh.h"
#include "renderer/tracing/embree/packet.h"
#include "renderer/tracing/host_tracer.h"
#include "renderer/tracing/thread_pool.h"
#include "renderer/tracing/world_hierarchy.h"

namespace lightwell {
namespace {

constexpr std::uint32_t kChunkRays = 1024;  // a multiple of 32, so that no two threads share a word of `visible`

// Lists of hits that threads fill chunk by chunk, joined in the order of the rays.
class ChunkLists {
 public:
  void resize(std::uint32_t rays) {
    hits_.resize(std::max<std::size_t>(hits_.size(), rays));
    ends_.assign((rays + kChunkRays - 1) / kChunkRays, 0);
  }

  // Of the chunk that begins at ray `begin`.
  void set(std::uint32_t begin, std::span<const std::uint32_t> hits) {
    std::copy(hits.begin(), hits.end(), hits_.begin() + begin);
    ends_[begin / kChunkRays] = static_cast<std::uint32_t>(hits.size());
  }

  // Their sum.
  std::uint32_t join(ThreadPool& pool, std::uint32_t* out) {
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    constexpr std::uint32_t kChunksAtOnce = 64;
    pool.parallel_for(
        static_cast<std::uint32_t>(ends_.size()), kChunksAtOnce, [&](std::uint32_t first, std::uint32_t end) {
          for (std::uint32_t chunk = first; chunk < end; ++chunk) {
            const std::uint32_t before = chunk == 0 ? 0 : ends_[chunk - 1];
            std::copy_n(hits_.data() + std::size_t{chunk} * kChunkRays, ends_[chunk] - before, out + before);
          }
        });
    return ends_.empty() ? 0 : ends_.back();
  }

 private:
  std::vector<std::uint32_t> hits_;  // a chunk's from its first ray on
  std::vector<std::uint32_t> ends_;  // by chunk: how many there are, then how many up to its end
};

template <int width>
void closest_hits(const EmbreeScene& scene, const Ray* rays, Hit* hits, ChunkLists* lists, std::uint32_t begin,
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
  if (lists) lists->set(begin, std::span(hit_rays).first(hit_count));
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

template <int width>
void closest_hits_at_once(const EmbreeScene& scene, std::span<const Ray> rays, std::span<Hit> hits) {
  closest_hits<width>(scene, rays.data(), hits.data(), nullptr, 0, static_cast<std::uint32_t>(rays.size()));
}

class EmbreeTracer final : public Tracer, private HostTracer {
 public:
  explicit EmbreeTracer(unsigned threads) : pool_(threads), scene_(threads) {
    if (rtcGetDeviceProperty(scene_.device(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0)
      width_ = 16;
    else if (rtcGetDeviceProperty(scene_.device(), RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0)
      width_ = 8;
  }

  std::string_view name() const override { return "embree"; }

  HostTracer* host() override { return this; }

  void update(const TraceScene& scene) override {
    scene_.update(scene, pool_);
    updated_ = scene;
    wide_hierarchy_.reset();
    compact_hierarchy_.reset();
  }

  void closest_hit(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits, HitList* list) override {
    LIGHTWELL_CHECK_OP(std::uint64_t{count} * sizeof(Hit), <=, hits.size_bytes());
    const Ray* in = of_host<Ray>(rays, count);
    Hit* out = host_of<Hit>(hits);
    ChunkLists* lists = list ? &chunk_lists_ : nullptr;
    if (lists) lists->resize(count);
    gl::wait_for_device();
    pool_.parallel_for(count, kChunkRays, [&](std::uint32_t begin, std::uint32_t end) {
      if (width_ == 16)
        lightwell::closest_hits<16>(scene_, in, out, lists, begin, end);
      else if (width_ == 8)
        lightwell::closest_hits<8>(scene_, in, out, lists, begin, end);
      else
        lightwell::closest_hits<4>(scene_, in, out, lists, begin, end);
    });
    if (list) finish(*list, chunk_lists_.join(pool_, host_of<std::uint32_t>(list->rays)));
  }

  void any_hit(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& visible) override {
    LIGHTWELL_CHECK_OP((std::uint64_t{count} + 31) / 32 * sizeof(std::uint32_t), <=, visible.size_bytes());
    const Ray* in = of_host<Ray>(rays, count);
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

  void test_candidates(const CandidateTest& test, gl::Buffer& hits, HitList& list) override {
    const std::uint64_t records = std::uint64_t{test.pixel_count} * test.direction_count;
    const std::uint64_t rays = std::uint64_t{test.patch_count} * test.direction_count;
    LIGHTWELL_CHECK_OP(records * sizeof(Hit), <=, hits.size_bytes());
    const MappedCandidateTest mapped{of_host<PixelOrigin>(test.pixels, test.pixel_count),
                                     of_host<glm::vec4>(test.directions, rays),
                                     of_host<Hit>(test.candidates, rays * test.group_count), test, host_of<Hit>(hits)};
    HitListWriter writer(host_of<std::uint32_t>(list.rays));
    gl::wait_for_device();
    pool_.parallel_for(test.pixel_count, kChunkPixels, [&](std::uint32_t begin, std::uint32_t end) {
      if (width_ == 16)
        lightwell::test_candidates<16>(scene_, mapped, writer, begin, end);
      else if (width_ == 8)
        lightwell::test_candidates<8>(scene_, mapped, writer, begin, end);
      else
        lightwell::test_candidates<4>(scene_, mapped, writer, begin, end);
    });
    host_of<std::uint32_t>(list.dispatch)[4] += writer.traced_anew();
    finish(list, writer.count());
  }

  std::uint64_t memory_bytes() const override {
    return scene_.memory_bytes() + world_hierarchy_.memory_bytes() + compact_scene_.memory_bytes();
  }

 private:
  void parallel_for(std::uint32_t count, std::uint32_t chunk,
                    const std::function<void(std::uint32_t, std::uint32_t)>& body) override {
    pool_.parallel_for(count, chunk, [&](std::uint32_t begin, std::uint32_t end) {
      const FlushDenormals flush;
      body(begin, end);
    });
  }
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const override {
    if (width_ == 16)
      closest_hits_at_once<16>(scene_, rays, hits);
    else if (width_ == 8)
      closest_hits_at_once<8>(scene_, rays, hits);
    else
      closest_hits_at_once<4>(scene_, rays, hits);
  }
  const WideHierarchy* wide_hierarchy() override {
    if (!wide_hierarchy_) wide_hierarchy_ = world_hierarchy_.update(updated_, pool_);
    return *wide_hierarchy_;
  }
  const CompactHierarchy* compact_hierarchy() override {
    const auto build = [&](std::span<const Box> boxes) { return embree_bvh(scene_.device(), boxes, kWide); };
    if (!compact_hierarchy_) compact_hierarchy_ = compact_scene_.update(updated_, pool_, build);
    return *compact_hierarchy_;
  }
  std::array<glm::vec3, 3> corners_ws(std::uint32_t instance, std::uint32_t triangle) const override {
    return scene_.corners_ws(instance, triangle);
  }

  template <class T>
  static T* host_of(gl::Buffer& buffer) {
    LIGHTWELL_CHECK(buffer.host() != nullptr);
    return reinterpret_cast<T*>(buffer.host());
  }
  template <class T>
  static const T* of_host(const gl::Buffer& buffer, std::uint64_t count) {
    LIGHTWELL_CHECK(buffer.host() != nullptr);
    LIGHTWELL_CHECK_OP(count * sizeof(T), <=, buffer.size_bytes());
    return reinterpret_cast<const T*>(buffer.host());
  }
  static void finish(HitList& list, std::uint32_t hit_count) {
    std::uint32_t* dispatch = host_of<std::uint32_t>(list.dispatch);
    dispatch[0] = (hit_count + kHitGroup - 1) / kHitGroup;
    dispatch[1] = dispatch[2] = 1;
    dispatch[3] = hit_count;
  }

  ThreadPool pool_;
  EmbreeScene scene_;
  TraceScene updated_;  // valid as long as the frame's Pose
  WorldHierarchy world_hierarchy_;
  std::optional<const WideHierarchy*> wide_hierarchy_;  // once it was asked for since the update
  CompactScene compact_scene_;
  std::optional<const CompactHierarchy*> compact_hierarchy_;  // likewise
  ChunkLists chunk_lists_;
  int width_ = 4;
};

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(unsigned threads) {
  return std::make_unique<EmbreeTracer>(threads);
}

}  // namespace lightwell
