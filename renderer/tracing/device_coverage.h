// What the compute tracer's shaders know of alpha: a test for each instance, texture coordinates and alpha planes.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "renderer/tracing/coverage.h"
#include "renderer/tracing/device_pool.h"

namespace lightwell {

/// std430, 64 bytes; `coverage_words` in coverage.glsl.
struct DeviceCoverage {
  std::uint32_t outcome, min_texel, blend_factor, wraps;         // wraps: s | t << 8
  std::uint32_t first_texel, width_px, height_px, first_corner;  // width 0: no image
  glm::vec4 u_row, v_row;                                        // w is unused
};
static_assert(sizeof(DeviceCoverage) == 64);

class DeviceCoverageTests {
 public:
  DeviceCoverageTests();

  /// Takes the instances of this frame and forgets what none has shown for `patience` frames. True for each instance
  /// of which some hits must be tested.
  std::vector<bool> update(const TraceScene& scene, std::uint64_t patience);

  /// Some instance needs a test; only then is what is bound of use.
  bool are_needed() const { return are_needed_; }
  void bind() const;
  std::uint64_t memory_bytes() const;

 private:
  struct CornerUvs {
    std::shared_ptr<const Primitive> primitive;
    PoolRange range;
    std::uint64_t last_used = 0;
  };
  struct AlphaPlane {
    std::shared_ptr<const Image> image;
    PoolRange words;
    std::uint64_t last_used = 0;
  };

  DeviceCoverage device_coverage(const CoverageTest& test, const TraceScene& scene, std::size_t instance);
  std::uint32_t first_corner(const std::shared_ptr<const Primitive>& primitive, int uv_set);
  std::uint32_t first_texel(const std::shared_ptr<const Image>& image);

  DevicePool corner_uvs_, alpha_;
  std::map<std::pair<const Primitive*, int>, CornerUvs> corners_;  // by uv set as well
  std::unordered_map<const Image*, AlphaPlane> planes_;
  AlphaRanges alpha_ranges_;
  gl::Buffer buffer_;
  std::vector<DeviceCoverage> tests_;  // as they stand in the buffer
  bool are_needed_ = false;
  std::uint64_t frame_ = 0;
};

}  // namespace lightwell
