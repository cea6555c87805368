// What `realtime` knows about a pixel besides its light, to be looked at: how long its history is, how much its light
// varies and changes, how it moves, its cell of the radiance cache, whether the indirect map has its surface.
#pragma once

#include "renderer/gl/program.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/radiance_cache.h"
#include "renderer/passes/reconstruction.h"
#include "renderer/renderer.h"

namespace lightwell {

class HistoryViewPass {
 public:
  explicit HistoryViewPass(gl::ShaderLibrary& shaders);

  /// Whether it is one of this pass.
  static bool shows(ViewKind view);

  /// Of the picture's size; values from 0 to 1. `previous_clip_from_world`: the camera of the frame before with this
  /// frame's shift of the picture.
  const gl::Texture& run(const GBuffer& g_buffer, const DeviceScene& scene, const ReconstructedMap& map,
                         const RadianceCache& cache, const glm::mat4& previous_clip_from_world, ViewKind view);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p), cache(p), view(p, "view"), previous_clip_from_world(p, "previous_clip_from_world") {}
    gl::ProgramPtr program;
    RadianceCacheUniforms cache;
    gl::Uniform<int> view;
    gl::Uniform<glm::mat4> previous_clip_from_world;
  };
  gl::Variants<Variant> variants_;
  gl::Texture image_;
  gl::Framebuffer framebuffer_;
  gl::EmptyVertexArray full_screen_;
};

}  // namespace lightwell
