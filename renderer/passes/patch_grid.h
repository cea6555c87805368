// The indirect map of `realtime` in one frame; the uniforms of shaders/patch_samples.glsl.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/gl/program.h"

namespace lightwell {

struct PatchGrid {
  glm::ivec2 map_size_px{1};
  glm::ivec2 picture_size_px{1};
  std::uint32_t rays_per_texel = 1;
  std::uint32_t frame_number = 0;  // of the view; decides which pixels stand for their patches, and all random numbers
  std::uint32_t seed = 0;

  std::uint32_t texels() const {
    return static_cast<std::uint32_t>(map_size_px.x) * static_cast<std::uint32_t>(map_size_px.y);
  }
  std::uint32_t samples() const { return texels() * rays_per_texel; }
};

/// Where in the light of samples that begins which has not bounced: behind two places a ray and the lamps' one a texel.
inline std::uint32_t first_direct(const PatchGrid& grid) {
  return 2 * grid.samples() + grid.texels();
}

class PatchGridUniforms {
 public:
  explicit PatchGridUniforms(const gl::ProgramPtr& program)
      : map_size_px_(program, "map_size_px"),
        pixels_per_texel_(program, "pixels_per_texel"),
        rays_per_texel_(program, "rays_per_texel"),
        frame_number_(program, "frame_number"),
        seed_(program, "seed") {}
  void set(const PatchGrid& grid) const {
    map_size_px_ = grid.map_size_px;
    pixels_per_texel_ = glm::vec2(grid.picture_size_px) / glm::vec2(grid.map_size_px);
    rays_per_texel_ = grid.rays_per_texel;
    frame_number_ = grid.frame_number;
    seed_ = grid.seed;
  }

 private:
  gl::Uniform<glm::ivec2> map_size_px_;
  gl::Uniform<glm::vec2> pixels_per_texel_;
  gl::Uniform<std::uint32_t> rays_per_texel_, frame_number_, seed_;
};

}  // namespace lightwell
