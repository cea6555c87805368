// The views of what lies before the light: directions, hits, patches, candidates.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/hit_light.h"
#include "renderer/renderer.h"

namespace lightwell {

class MapViewPass {
 public:
  explicit MapViewPass(gl::ShaderLibrary& shaders);
  /// Empties the image.
  void resize(glm::ivec2 map_size_px);

  /// Whether a view is made here.
  static bool shows(ViewKind view);
  /// Whether the view needs `run` for the batch of directions that begins at `first`.
  static bool is_of_batch(const Settings& settings, std::uint32_t first, std::uint32_t count);

  /// Shows one direction of the batch, or what is the same for all.
  void run(const IndirectMapGrid& grid, const ActiveBlocks& blocks, const OcclusionRays& rays,
           const OcclusionMap& occlusion, const gl::Buffer& candidates, const Settings& settings);

  /// RGBA32F, one texel a pixel of the indirect map.
  const gl::Texture& image() const { return image_; }

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p);
    gl::ProgramPtr program;
    IndirectMapUniforms grid;
    gl::Uniform<int> view;
    gl::Uniform<std::uint32_t> direction, direction_count, patch_count, first_unmatched, group_count;
  };
  gl::Variants<Variant> variants_;
  gl::Texture image_;
};

}  // namespace lightwell
