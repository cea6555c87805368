// Light leaving the hits of the occlusion map: by direct light (thesis 4.2) or from the screen (4.3).
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/device_scene.h"
#include "renderer/passes/directions.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/shadow_maps.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

/// The nearest hit of each pixel along each of a batch of directions: M(p, d_j) of the thesis. Record j * slots + slot.
struct OcclusionMap {
  /// `buffers`: host-visible for a native tracer.
  explicit OcclusionMap(gl::BufferUse buffers) : hits("hits", 0, buffers), list(buffers) {}
  void resize(std::uint32_t most_records);

  gl::Buffer hits;                                 // Hit
  gl::BufferTexture hit_texels{"hits", GL_R32UI};  // the same, 5 texels a hit
  HitList list;
  gl::Buffer arriving{"arriving light", 0};  // vec4: radiance that leaves the hits towards the pixels
  gl::BufferTexture arriving_texels{"arriving light", GL_RGBA32F};
  const gl::BufferTexture* cleared_texels = nullptr;  // of ClearHitsPass, where the scene has clear surfaces

  /// Binds what the shaders of the defines read.
  void bind_cleared() const;
  gl::Defines clear_defines() const;
};

/// The rays whose hits an OcclusionMap holds.
struct OcclusionRays {
  const Directions& directions;
  const Patches& patches;
  std::uint32_t slots;
};

class HitLightPass {
 public:
  explicit HitLightPass(gl::ShaderLibrary& shaders);

  /// Emission and reflected direct light of the hits. `literal`: weighted as Algorithm 2 prints it.
  void run(const DeviceScene& scene, const OcclusionRays& rays, const OcclusionMap& occlusion,
           const ShadowMaps& shadows, bool literal);

  /// What the previous bounce's indirect map shows where a hit is seen by the camera, else nothing.
  void run_from_screen(const GBuffer& g_buffer, const OcclusionRays& rays, const OcclusionMap& occlusion,
                       const gl::Texture& previous_bounce);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p), slot_count(p, "slot_count"), patch_count(p, "patch_count") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> slot_count, patch_count;
  };
  void dispatch(Variant& variant, const OcclusionRays& rays, const OcclusionMap& occlusion) const;
  gl::Variants<Variant> from_lights_, from_screen_;
};

}  // namespace lightwell
