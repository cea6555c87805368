// The indirect lighting map (thesis 4.2, Algorithm 2) and its optional filter.
#pragma once

#include "renderer/gl/texture.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/directions.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/hit_light.h"

namespace lightwell {

/// Indirect light of one bounce or of several, divided by the directional albedo of the pixels it was gathered at.
/// RGBA32F, premultiplied by validity in a, sampled bilinearly.
struct IndirectMap {
  gl::Texture image;
};

/// Makes an empty map of this size.
IndirectMap make_indirect_map(glm::ivec2 size_px);

/// How the hits of a batch are summed.
struct Gathering {
  std::uint32_t total_directions;
  bool literal;                 // the sum as Algorithm 2 prints it
  bool misses_see_environment;  // in the first bounce, corrected
  bool with_guide;              // makes occlusion_distance() and guide() in the first batch
};

class GatherPass {
 public:
  explicit GatherPass(gl::ShaderLibrary& shaders);
  void resize(glm::ivec2 map_size_px);

  /// Adds a batch of directions to `map`; the first batch starts it anew.
  void run(const DeviceScene& scene, const GBuffer& g_buffer, const IndirectMapGrid& grid, const ActiveBlocks& blocks,
           const OcclusionRays& rays, const OcclusionMap& occlusion, const Gathering& gathering, IndirectMap& map);

  /// Makes `map` of sums that are made already: a vec4 a slot, light times weight over all directions and the mean
  /// distance of the hits, metres.
  void run_summed(const GBuffer& g_buffer, const IndirectMapGrid& grid, const ActiveBlocks& blocks,
                  const gl::BufferTexture& sums, std::uint32_t total_directions, bool with_guide, IndirectMap& map);

  /// Mean distance of a pixel's hits in the first batch, metres (R32F).
  const gl::Texture& occlusion_distance() const { return occlusion_distance_; }
  /// Position, normal and roughness of the points gathered at, for the filter (RGBA32UI).
  const gl::Texture& guide() const { return guide_; }

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p);
    gl::ProgramPtr program;
    IndirectMapUniforms grid;
    gl::Uniform<std::uint32_t> direction_count, total_directions, patch_count;
    gl::Uniform<int> first_batch;
    gl::Uniform<float> environment_share;
  };
  void bind(const GBuffer& g_buffer, const ActiveBlocks& blocks, const IndirectMap& map) const;
  static void dispatch(const Variant& variant, const IndirectMap& map);
  gl::Variants<Variant> variants_;
  gl::Texture occlusion_distance_, guide_;
};

/// An edge-stopping a-trous filter over the map; not in the thesis.
class IndirectFilterPass {
 public:
  explicit IndirectFilterPass(gl::ShaderLibrary& shaders);
  void resize(glm::ivec2 map_size_px);
  void run(const gl::Texture& guide, IndirectMap& map);

 private:
  gl::ProgramPtr program_;
  gl::Uniform<int> stride_;
  IndirectMap scratch_;
};

/// Adds one bounce's map to the sum of all: sum += bounce.
class AddMapsPass {
 public:
  explicit AddMapsPass(gl::ShaderLibrary& shaders);
  void run(const IndirectMap& bounce, IndirectMap& sum, bool first);

 private:
  gl::ProgramPtr program_;
  gl::Uniform<int> first_;
};

}  // namespace lightwell
