// The sampling direction map (thesis 3.1).
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/active_blocks.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/indirect_map_grid.h"
#include "renderer/passes/patches.h"

namespace lightwell {

/// A batch of directions for every patch, as rays from its point. Ray j * patches + patch is direction first + j.
struct Directions {
  gl::Buffer rays;                                   // Ray
  gl::BufferTexture ray_texels{"rays", GL_RGBA32F};  // the same, 2 texels a ray
  gl::Buffer directions;                             // vec4: direction and pdf (0: no ray)
  gl::BufferTexture direction_texels{"directions", GL_RGBA32F};
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t ray_count = 0;
};

class DirectionsPass {
 public:
  /// `buffers`: host-visible where a native tracer reads the rays.
  DirectionsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);
  void resize(std::uint32_t most_rays);
  Directions& run(const DeviceScene& scene, const GBuffer& g_buffer, const IndirectMapGrid& grid,
                  const ActiveBlocks& blocks, const Patches& patches, std::uint32_t first, std::uint32_t count,
                  std::uint32_t seed);

 private:
  void make_sample_points(std::uint32_t first, std::uint32_t count, std::uint32_t seed);

  gl::ProgramPtr points_program_;
  gl::Uniform<std::uint32_t> points_first_, points_count_, points_seed_;
  gl::Buffer points_;
  gl::BufferTexture point_texels_;
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p),
          grid(p),
          count(p, "direction_count"),
          patch_count(p, "patch_count"),
          first_unmatched(p, "first_unmatched") {}
    gl::ProgramPtr program;
    IndirectMapUniforms grid;
    gl::Uniform<std::uint32_t> count, patch_count, first_unmatched;
  };
  gl::Variants<Variant> variants_;
  Directions directions_;
};

}  // namespace lightwell
