// Alpha coverage at a hit, decided alike on the CPU and in shaders/coverage.glsl: the texel is found in floating point,
// every decision after it is made in integers.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "renderer/tracing/tracer.h"

namespace lightwell {

/// A Coverage made ready for one frame.
struct CoverageTest {
  enum class Outcome : std::uint8_t { kAlwaysHit, kNeverHit, kMask, kBlend };
  Outcome outcome = Outcome::kAlwaysHit;
  std::uint32_t min_texel = 0;     // kMask: the least texel alpha (0..255) that hits
  std::uint32_t blend_factor = 0;  // kBlend: Coverage::factor in 1/65536, at most 65536
  const Image* image = nullptr;    // null: a texel of 255 everywhere
  int uv_set = 0;
  glm::vec3 u_row{1.0f, 0.0f, 0.0f};  // u' = dot(u_row, (u, v, 1)), likewise v'
  glm::vec3 v_row{0.0f, 1.0f, 0.0f};
  Wrap wrap_s = Wrap::kRepeat, wrap_t = Wrap::kRepeat;
};

/// The least and greatest alpha of images, kept while they are in use, so that a material that is called
/// transparent but has no transparent texel costs no test.
class AlphaRanges {
 public:
  struct Range {
    std::uint8_t least = 255, greatest = 255;
  };
  Range of(const std::shared_ptr<const Image>& image);
  /// Forgets the images that nothing else holds any more.
  void drop_unused();

 private:
  struct Entry {
    std::shared_ptr<const Image> image;
    Range range;
  };
  std::unordered_map<const Image*, Entry> ranges_;
};

CoverageTest prepare_coverage(const Coverage& coverage, const Primitive& primitive, AlphaRanges& ranges);

/// True where the triangle counts: `u`, `v` are the barycentrics of the hit.
bool is_covered(const CoverageTest& test, const Primitive& primitive, std::uint32_t instance, std::uint32_t triangle,
                float u, float v);

/// The threshold in [0, 2^24) that alpha * 2^24 is held against. It is constant on cells of 1/4096 in u and v, so that
/// the last bits of the barycentrics, in which tracers differ, seldom matter.
std::uint32_t coverage_threshold(std::uint32_t instance, std::uint32_t triangle, float u, float v);

/// The texel's column or row for a texture coordinate, as GL's nearest filter finds it.
int nearest_texel(float coordinate, int size_px, Wrap wrap);

}  // namespace lightwell
