// The indirect map of `realtime` in one frame; the uniforms of shaders/patch_samples.glsl.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/gl/program.h"

namespace lightwell {

struct PatchGrid {
  glm::ivec2 map_size_px{1};
  glm::ivec2 picture_size_px{1};
  std::uint32_t rays_per_texel = 1;  // in a frame in which the texel has any
  /// Logarithms to base 2: so many texels across and up are a patch, of which one has rays in every frame, by turns.
  glm::uvec2 log2_patch{0};        // (0, 0), (1, 0) or (1, 1)
  std::uint32_t frame_number = 0;  // of the view; decides which pixels stand for their patches, and all random numbers
  std::uint32_t seed = 0;

  std::uint32_t frames_of_patch() const {
    return 1u << (log2_patch.x + log2_patch.y);
  }  // until all its texels had rays
  glm::ivec2 patches() const { return (map_size_px + (1 << glm::ivec2(log2_patch)) - 1) >> glm::ivec2(log2_patch); }

  /// The place within its patch of the texel that has rays in this frame; neighbours in time are diagonal to each
  /// other.
  glm::ivec2 traced_place() const {
    const std::uint32_t turn = frame_number % frames_of_patch();
    return {static_cast<int>(turn & 1u), static_cast<int>((turn ^ turn >> 1) & log2_patch.y)};
  }

  std::uint32_t traced_texels() const {
    return static_cast<std::uint32_t>(patches().x) * static_cast<std::uint32_t>(patches().y);
  }
  std::uint32_t samples() const { return traced_texels() * rays_per_texel; }
};

/// Where in the light of samples that begins which has not bounced: behind two places a ray and the lamps' one a texel.
inline std::uint32_t first_direct(const PatchGrid& grid) {
  return 2 * grid.samples() + grid.traced_texels();
}

class PatchGridUniforms {
 public:
  explicit PatchGridUniforms(const gl::ProgramPtr& program)
      : map_size_px_(program, "map_size_px"),
        pixels_per_texel_(program, "pixels_per_texel"),
        rays_per_texel_(program, "rays_per_texel"),
        frame_number_(program, "frame_number"),
        seed_(program, "seed"),
        patches_(program, "patches"),
        log2_patch_(program, "log2_patch"),
        traced_place_(program, "traced_place") {}
  void set(const PatchGrid& grid) const {
    map_size_px_ = grid.map_size_px;
    pixels_per_texel_ = glm::vec2(grid.picture_size_px) / glm::vec2(grid.map_size_px);
    rays_per_texel_ = grid.rays_per_texel;
    frame_number_ = grid.frame_number;
    seed_ = grid.seed;
    patches_ = grid.patches();
    log2_patch_ = glm::ivec2(grid.log2_patch);
    traced_place_ = grid.traced_place();
  }

 private:
  gl::Uniform<glm::ivec2> map_size_px_;
  gl::Uniform<glm::vec2> pixels_per_texel_;
  gl::Uniform<std::uint32_t> rays_per_texel_, frame_number_, seed_;
  gl::Uniform<glm::ivec2> patches_, log2_patch_, traced_place_;
};

}  // namespace lightwell
