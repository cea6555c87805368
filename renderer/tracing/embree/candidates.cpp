#include "renderer/tracing/embree/candidates.h"

#include <cstring>
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

// Four lanes at a time, which every processor of this kind has. A run is not a multiple of four: what is written beyond
// its end belongs to the next run, which writes all its lanes anew, or to the padding.
constexpr std::uint32_t kWidth = 4;
using Float4 = float __attribute__((vector_size(16)));
using Uint4 = std::uint32_t __attribute__((vector_size(16)));

template <class Vector, class Scalar>
Vector load(const Scalar* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof vector);
  return vector;
}
template <class Vector, class Scalar>
void store(Scalar* to, Vector vector) {
  std::memcpy(to, &vector, sizeof vector);
}

struct Lanes {
  using Floats = std::array<float, kChunkPixels + kWidth>;
  using Numbers = std::array<std::uint32_t, kChunkPixels + kWidth>;
  Floats x, y, z;                 // PixelOrigin::above_ws
  Floats down_x, down_y, down_z;  // PixelOrigin::down_ws
  Floats from_x, from_y, from_z;  // origins of the rays of the direction at hand
  Floats t, u, v;                 // nearest so far
  Floats new_t, new_u, new_v;     // of the candidate at hand; new_t is kNothing where it is not met
  Numbers instance, triangle;
};

void place_origins(Lanes& l, const Run& run, glm::vec3 d) {
  const Float4 zero = {}, nothing = zero + kNothing;
  for (std::uint32_t i = run.begin; i < run.end; i += kWidth) {
    const auto x = load<Float4>(&l.down_x[i]), y = load<Float4>(&l.down_y[i]), z = load<Float4>(&l.down_z[i]);
    const auto below = x * d.x + y * d.y + z * d.z > zero;
    store(&l.from_x[i], load<Float4>(&l.x[i]) + (below ? x : zero));
    store(&l.from_y[i], load<Float4>(&l.y[i]) + (below ? y : zero));
    store(&l.from_z[i], load<Float4>(&l.z[i]) + (below ? z : zero));
    store(&l.t[i], nothing);
  }
}

void meet(Lanes& l, const Run& run, const AffineTriangle& a) {
  const Float4 zero = {}, nothing = zero + kNothing, least = zero - kEdgeTolerance, most = zero + 1.0f + kEdgeTolerance;
  for (std::uint32_t i = run.begin; i < run.end; i += kWidth) {
    const Float4 x = load<Float4>(&l.from_x[i]) - a.corner.x, y = load<Float4>(&l.from_y[i]) - a.corner.y;
    const Float4 z = load<Float4>(&l.from_z[i]) - a.corner.z;
    const Float4 u = x * a.u.x + y * a.u.y + z * a.u.z;
    const Float4 v = x * a.v.x + y * a.v.y + z * a.v.z;
    const Float4 t = x * a.t.x + y * a.t.y + z * a.t.z;
    const auto met = (u >= least) & (v >= least) & (u + v <= most) & (t > zero);
    store(&l.new_t[i], met ? t : nothing);
    store(&l.new_u[i], u > zero ? u : zero);
    store(&l.new_v[i], v > zero ? v : zero);
  }
}

void keep_nearer(Lanes& l, const Run& run, std::uint32_t instance, std::uint32_t triangle) {
  const Uint4 instances = Uint4{} + instance, triangles = Uint4{} + triangle;
  for (std::uint32_t i = run.begin; i < run.end; i += kWidth) {
    const auto t = load<Float4>(&l.t[i]), new_t = load<Float4>(&l.new_t[i]);
    const auto nearer = new_t < t;
    store(&l.t[i], nearer ? new_t : t);
    store(&l.u[i], nearer ? load<Float4>(&l.new_u[i]) : load<Float4>(&l.u[i]));
    store(&l.v[i], nearer ? load<Float4>(&l.new_v[i]) : load<Float4>(&l.v[i]));
    store(&l.instance[i], nearer ? instances : load<Uint4>(&l.instance[i]));
    store(&l.triangle[i], nearer ? triangles : load<Uint4>(&l.triangle[i]));
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
    lanes_ = {};  // what lies beyond the last run is computed with, too
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
    place_origins(lanes_, run, along);
    bool had_any = false;
    for (std::uint32_t group = 0; group < test.group_count; ++group) {
      const Hit& candidate = mapped_.candidates[std::size_t{group} * test.direction_count * test.patch_count + ray];
      if (candidate.t < 0.0f) continue;
      had_any = true;
      try_candidate(run, candidate.instance, candidate.triangle * test.group_count + group, along);
    }
    store_hits(run, direction, along, had_any && test.trace_missed);
  }

  void try_candidate(const Run& run, std::uint32_t instance, std::uint32_t triangle, glm::vec3 along) {
    const AffineTriangle affine = affine_triangle(scene_.corners_ws(instance, triangle), along);
    meet(lanes_, run, affine);
    if (scene_.needs_coverage(instance))
      for (std::uint32_t i = run.begin; i < run.end; ++i)
        if (lanes_.new_t[i] < kNothing && !scene_.is_covered(instance, triangle, lanes_.new_u[i], lanes_.new_v[i]))
          lanes_.new_t[i] = kNothing;
    keep_nearer(lanes_, run, instance, triangle);
  }

  void store_hits(const Run& run, std::uint32_t direction, glm::vec3 along, bool trace_missed) {
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
    list_.count_traced_anew(missed_.size());
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
