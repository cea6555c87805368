// From the few samples of a frame to a smooth indirect map: what earlier frames found is kept where surfaces are the
// same, and what noise is left is filtered.
#pragma once

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/patch_grid.h"
#include "renderer/passes/patch_samples.h"
#include "renderer/passes/sample_sums.h"

namespace lightwell {

/// Light over directional albedo per texel, RGBA32F, a: 1 where there is a surface.
struct ReconstructedMap {
  const gl::Texture* image = nullptr;
  const gl::Texture* guide = nullptr;       // RGBA32UI: position, normal and roughness
  const gl::Texture* unfiltered = nullptr;  // RGBA32F; a: frames in it
  const gl::Texture* moments = nullptr;     // RGBA32F, of luminance: first, second, first of late frames
};

class ReconstructionPass {
 public:
  explicit ReconstructionPass(gl::ShaderLibrary& shaders);

  /// A new size forgets the history.
  void resize(glm::ivec2 map_size_px);
  void forget() { has_history_ = false; }

  /// A black map, for no bounces.
  ReconstructedMap nothing() const;

  /// `previous_clip_from_world`: the camera of the frame before. `kept_frames`: what the history counts for at most.
  ReconstructedMap run(const GBuffer& g_buffer, const DeviceScene& scene, const PatchSamples& samples,
                       const PatchGrid& grid, const glm::mat4& previous_clip_from_world, float kept_frames);

 private:
  struct Light {
    explicit Light(const gl::ProgramPtr& p);
    gl::ProgramPtr program;
    SampleSumUniforms sums;
    gl::Uniform<int> has_history;
    gl::Uniform<glm::mat4> previous_clip_from_world;
    gl::Uniform<float> kept_frames;
  };
  struct Filter {
    explicit Filter(const gl::ProgramPtr& p) : program(p), stride(p, "stride"), tolerance(p, "luminance_tolerance") {}
    gl::ProgramPtr program;
    gl::Uniform<int> stride;
    gl::Uniform<float> tolerance;
  };
  struct History {
    gl::Texture map, moments, guide;
    gl::Framebuffer framebuffer;
  };
  struct Scratch {
    gl::Texture map;
    gl::Framebuffer framebuffer;
  };
  ReconstructedMap filter();

  gl::Variants<Light> light_;
  Filter filter_, filter_last_;
  History now_, before_;
  Scratch scratch_[2];  // the first: what the filter begins with
  bool has_history_ = false;
  gl::EmptyVertexArray full_screen_;
};

}  // namespace lightwell
