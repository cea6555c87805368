#include "renderer/tracing/embree/candidates.h"

#include <limits>

namespace lightwell {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr float kEdgeTolerance = 1e-6f;  // of barycentrics: rounding, so that no ray passes between two candidates

// Consecutive pixels that refer to the same patch.
struct Run {
  std::uint32_t begin, end;  // within the chunk
  std::uint32_t patch_index;
};

// A candidate as the rays of one direction see it: barycentrics and distance are affine in the origin
// (Moeller and Trumbore 1997, with the triple products taken apart).
struct AffineTriangle {
  glm::vec3 corner, u, v, t;
};

struct Lanes {
  using Floats = std::array<float, kChunkPixels>;
  alignas(64) Floats x, y, z;                 // PixelOrigin::above_ws
  alignas(64) Floats down_x, down_y, down_z;  // PixelOrigin::down_ws
  alignas(64) Floats from_x, from_y, from_z;  // origins of the rays of the direction at hand
  alignas(64) Floats t, u, v;                 // nearest so far
  alignas(64) Floats new_t, new_u, new_v;     // of the candidate at hand; new_t is kNothing where it is not met
  alignas(64) std::array<std::uint32_t, kChunkPixels> instance, triangle;
};

[[gnu::always_inline]] inline void place_origins(Lanes& l, std::uint32_t begin, std::uint32_t end, glm::vec3 d) {
  for (std::uint32_t i = begin; i < end; ++i) {
    const float below = l.down_x[i] * d.x + l.down_y[i] * d.y + l.down_z[i] * d.z > 0.0f ? 1.0f : 0.0f;
    l.from_x[i] = l.x[i] + below * l.down_x[i];
    l.from_y[i] = l.y[i] + below * l.down_y[i];
    l.from_z[i] = l.z[i] + below * l.down_z[i];
    l.t[i] = kNothing;
  }
}

[[gnu::always_inline]] inline void meet(Lanes& l, std::uint32_t begin, std::uint32_t end, const AffineTriangle& a) {
  for (std::uint32_t i = begin; i < end; ++i) {
    const float x = l.from_x[i] - a.corner.x, y = l.from_y[i] - a.corner.y, z = l.from_z[i] - a.corner.z;
    const float u = x * a.u.x + y * a.u.y + z * a.u.z;
    const float v = x * a.v.x + y * a.v.y + z * a.v.z;
    const float t = x * a.t.x + y * a.t.y + z * a.t.z;
    const bool met = (u >= -kEdgeTolerance) & (v >= -kEdgeTolerance) & (u + v <= 1.0f + kEdgeTolerance) & (t > 0.0f);
    l.new_t[i] = met ? t : kNothing;
    l.new_u[i] = std::max(u, 0.0f);
    l.new_v[i] = std::max(v, 0.0f);
  }
}

[[gnu::always_inline]] inline void keep_nearer(Lanes& l, std::uint32_t begin, std::uint32_t end, std::uint32_t instance,
                                               std::uint32_t triangle) {
  for (std::uint32_t i = begin; i < end; ++i) {
    const bool nearer = l.new_t[i] < l.t[i];
    l.t[i] = nearer ? l.new_t[i] : l.t[i];
    l.u[i] = nearer ? l.new_u[i] : l.u[i];
    l.v[i] = nearer ? l.new_v[i] : l.v[i];
    l.instance[i] = nearer ? instance : l.instance[i];
    l.triangle[i] = nearer ? triangle : l.triangle[i];
  }
}

AffineTriangle affine_triangle(const std::array<glm::vec3, 3>& corners, glm::vec3 direction) {
  const glm::vec3 b = corners[1] - corners[0], c = corners[2] - corners[0];
  const glm::vec3 across = glm::cross(direction, c);
  const float inverse = 1.0f / glm::dot(b, across);  // infinite for a ray in the plane: nothing compares true with NaN
  return {corners[0], across * inverse, glm::cross(b, direction) * inverse, glm::cross(b, c) * inverse};
}

// All directions of a chunk of pixels.
template <int width>
class Chunk {
 public:
  Chunk(const EmbreeScene& scene, const MappedCandidateTest& mapped, HitListWriter& list, std::uint32_t begin,
        std::uint32_t end)
      : scene_(scene), mapped_(mapped), list_(list), first_(begin), count_(end - begin) {
    for (std::uint32_t i = 0; i < count_; ++i) {
      const PixelOrigin& pixel = mapped.pixels[begin + i];
      lanes_.x[i] = pixel.above_ws.x, lanes_.y[i] = pixel.above_ws.y, lanes_.z[i] = pixel.above_ws.z;
      lanes_.down_x[i] = pixel.down_ws.x, lanes_.down_y[i] = pixel.down_ws.y, lanes_.down_z[i] = pixel.down_ws.z;
      if (run_count_ == 0 || runs_[run_count_ - 1].patch_index != pixel.patch_index)
        runs_[run_count_++] = {i, i, pixel.patch_index};
      ++runs_[run_count_ - 1].end;
    }
  }

  void run() {
    for (std::uint32_t direction = 0; direction < mapped_.test.direction_count; ++direction) {
      for (std::uint32_t r = 0; r < run_count_; ++r) test(runs_[r], direction);
      flush_list();
    }
    if (!missed_.is_empty()) trace_missed();
    flush_list();
  }

 private:
  void test(const Run& run, std::uint32_t direction) {
    if (run.patch_index == kNoPatch) return store_misses(run, direction);
    const CandidateTest& test = mapped_.test;
    const std::size_t ray = std::size_t{direction} * test.patch_count + run.patch_index;
    const glm::vec3 along(mapped_.directions[ray]);
    place_origins(lanes_, run.begin, run.end, along);
    bool had_any = false;
    for (std::uint32_t group = 0; group < test.group_count; ++group) {
      const Hit& candidate = mapped_.candidates[std::size_t{group} * test.direction_count * test.patch_count + ray];
      if (candidate.t < 0.0f) continue;
      had_any = true;
      try_candidate(run, candidate.instance, candidate.triangle * test.group_count + group, along);
    }
    store(run, direction, along, had_any && test.trace_missed);
  }

  void try_candidate(const Run& run, std::uint32_t instance, std::uint32_t triangle, glm::vec3 along) {
    const AffineTriangle affine = affine_triangle(scene_.corners_ws(instance, triangle), along);
    meet(lanes_, run.begin, run.end, affine);
    if (scene_.needs_coverage(instance))
      for (std::uint32_t i = run.begin; i < run.end; ++i)
        if (lanes_.new_t[i] < kNothing && !scene_.is_covered(instance, triangle, lanes_.new_u[i], lanes_.new_v[i]))
          lanes_.new_t[i] = kNothing;
    keep_nearer(lanes_, run.begin, run.end, instance, triangle);
  }

  void store(const Run& run, std::uint32_t direction, glm::vec3 along, bool trace_missed) {
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const std::uint32_t record = record_of(i, direction);
      if (lanes_.t[i] < kNothing) {
        mapped_.hits[record] = {lanes_.t[i], lanes_.instance[i], lanes_.triangle[i], lanes_.u[i], lanes_.v[i]};
        add_to_list(record);
      } else if (trace_missed) {
        trace(record, {{lanes_.from_x[i], lanes_.from_y[i], lanes_.from_z[i]}, 0.0f, along, 1e30f});
      } else {
        mapped_.hits[record] = {kMiss, 0, 0, 0.0f, 0.0f};
      }
    }
  }

  void store_misses(const Run& run, std::uint32_t direction) {
    for (std::uint32_t i = run.begin; i < run.end; ++i)
      mapped_.hits[record_of(i, direction)] = {kMiss, 0, 0, 0.0f, 0.0f};
  }

  // With the next packet of them.
  void trace(std::uint32_t record, const Ray& ray) {
    mapped_.hits[record] = {kMiss, 0, 0, 0.0f, 0.0f};
    if (is_active(ray)) missed_.add(ray, record);
    if (missed_.is_full()) trace_missed();
  }

  void trace_missed() {
    missed_.intersect(scene_);
    for (int lane = 0; lane < missed_.size(); ++lane) {
      const Hit hit = missed_.hit(lane, scene_);
      mapped_.hits[missed_.ray(lane)] = hit;
      if (hit.t >= 0.0f) add_to_list(missed_.ray(lane));
    }
    missed_.clear();
  }

  std::uint32_t record_of(std::uint32_t lane, std::uint32_t direction) const {
    return direction * mapped_.test.pixel_count + first_ + lane;
  }
  void add_to_list(std::uint32_t record) {
    if (listed_ == found_.size()) flush_list();
    found_[listed_++] = record;
  }
  void flush_list() {
    list_.add(std::span(found_).first(listed_));
    listed_ = 0;
  }

  const EmbreeScene& scene_;
  const MappedCandidateTest& mapped_;
  HitListWriter& list_;
  const std::uint32_t first_, count_;
  Lanes lanes_;
  std::array<Run, kChunkPixels> runs_;
  std::uint32_t run_count_ = 0;
  Packet<width> missed_;
  std::array<std::uint32_t, kChunkPixels + width> found_;
  std::size_t listed_ = 0;
};

}  // namespace

template <int width>
void test_candidates(const EmbreeScene& scene, const MappedCandidateTest& mapped, HitListWriter& list,
                     std::uint32_t begin, std::uint32_t end) {
  const FlushDenormals flush;
  Chunk<width>(scene, mapped, list, begin, end).run();
}

template void test_candidates<4>(const EmbreeScene&, const MappedCandidateTest&, HitListWriter&, std::uint32_t,
                                 std::uint32_t);
template void test_candidates<8>(const EmbreeScene&, const MappedCandidateTest&, HitListWriter&, std::uint32_t,
                                 std::uint32_t);
template void test_candidates<16>(const EmbreeScene&, const MappedCandidateTest&, HitListWriter&, std::uint32_t,
                                  std::uint32_t);

}  // namespace lightwell
