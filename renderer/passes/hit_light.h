// Light leaving the hits of the occlusion map: by direct light (thesis 4.2) or from the screen (4.3).
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/passes/device_scene.h"
#include "renderer/passes/directions.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/shadow_maps.h"

namespace lightwell {

/// The nearest hit along each ray of a batch of directions: M(p, d_j) of the thesis, as records.
struct OcclusionMap {
  gl::Buffer hits;                                 // Hit
  gl::BufferTexture hit_texels{"hits", GL_R32UI};  // the same, 5 texels a hit
};

/// Radiance arriving along each ray of a batch.
struct HitRadiance {
  gl::Buffer radiance;  // 4 halves a ray
  gl::BufferTexture texels{"hit radiance", GL_RG32UI};
};

class HitLightPass {
 public:
  explicit HitLightPass(gl::ShaderLibrary& shaders);
  void resize(std::uint32_t most_rays);

  /// Emission and reflected direct light of the hits, the environment for misses. `literal`: weighted as Algorithm 2
  /// prints it.
  const HitRadiance& run(const DeviceScene& scene, const Directions& directions, const OcclusionMap& occlusion,
                         const ShadowMaps& shadows, bool literal);

  /// What the previous bounce's indirect map shows where a hit is seen by the camera, else nothing.
  const HitRadiance& run_from_screen(const GBuffer& g_buffer, const Directions& directions,
                                     const OcclusionMap& occlusion, const gl::Texture& previous_bounce);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p) : program(p), ray_count(p, "ray_count") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> ray_count;
  };
  void bind(const Directions& directions, const OcclusionMap& occlusion) const;
  Variant& variant_for(const DeviceScene& scene, bool literal);
  Variant plain_, many_lights_, base_color_textures_, general_, literal_;
  BrdfVariants<Variant> special_, special_literal_;
  gl::ProgramPtr screen_program_;
  gl::Uniform<std::uint32_t> screen_ray_count_;
  HitRadiance radiance_;
};

}  // namespace lightwell
