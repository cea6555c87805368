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

/// The nearest hit along each ray of a batch of directions: M(p, d_j) of the thesis, as records.
struct OcclusionMap {
  /// `buffers`: host-visible for a native tracer.
  explicit OcclusionMap(gl::BufferUse buffers) : hits("hits", 0, buffers), list(buffers) {}
  void resize(std::uint32_t most_rays);

  gl::Buffer hits;                                 // Hit
  gl::BufferTexture hit_texels{"hits", GL_R32UI};  // the same, 5 texels a hit
  HitList list;
  gl::Buffer hit_weights{"hit weights",
                         0};  // vec4, in the order of the list: what the first bounce found in `arriving`
};

class HitLightPass {
 public:
  explicit HitLightPass(gl::ShaderLibrary& shaders);

  /// Emission and reflected direct light of the hits takes the place of the unlit rays' weights in `directions`.
  /// `literal`: weighted as Algorithm 2 prints it.
  void run(const DeviceScene& scene, const OcclusionMap& occlusion, const ShadowMaps& shadows, bool literal,
           Directions& directions);

  /// What the previous bounce's indirect map shows where a hit is seen by the camera, else nothing.
  void run_from_screen(const GBuffer& g_buffer, const OcclusionMap& occlusion, const gl::Texture& previous_bounce,
                       bool literal, Directions& directions);

 private:
  void bind(const Directions& directions, const OcclusionMap& occlusion) const;
  gl::Variants<gl::ProgramPtr> from_lights_, from_screen_;
};

}  // namespace lightwell
