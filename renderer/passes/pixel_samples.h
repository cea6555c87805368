// Rays for single pixels, where the indirect map does not serve: what smooth surfaces mirror is sharper than it, and
// pixels that none of its texels is like would get the light of other surfaces.
#pragma once

#include "renderer/gl/variants.h"
#include "renderer/methods/frame_context.h"
#include "renderer/passes/clear_samples.h"
#include "renderer/passes/clear_shadows.h"
#include "renderer/passes/compose.h"
#include "renderer/passes/firefly_clamp.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/light_table.h"
#include "renderer/passes/pixel_lists.h"
#include "renderer/passes/radiance_cache.h"
#include "renderer/passes/reconstruction.h"
#include "renderer/passes/sample_wave.h"
#include "renderer/passes/smooth_paths.h"

namespace lightwell {

/// What pixels are sampled with, and the picture's history.
struct PixelSampling {
  const GBuffer& g_buffer;
  const LightTable& lights;  // bound
  const RadianceCache& cache;
  const ReconstructedMap& map;
  glm::mat4 previous_clip_from_world;
  float kept_frames = 0.0f;  // that reflections found before count for at most
  bool all_rests = false;    // neither camera nor scene has moved since the frame before
  std::uint32_t frame_number = 0;
  FireflyClampPass* firefly_clamp = nullptr;  // null: off
};

class PixelSamplesPass {
 public:
  enum class Kind {
    kReflections,    // what smooth surfaces mirror
    kClearSurfaces,  // all that clear surfaces send back, and what is seen through those of volumes
    kUnmatched       // all else, in place of what the map gave
  };

  /// `buffers`: where rays and hits live; host-visible for a native tracer.
  PixelSamplesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers, Kind kind);

  /// Adds to `picture` what the rays of `count` pixels of `list` find.
  void run(FrameContext& frame, const Picture& picture, const gl::Buffer& list, std::uint32_t count,
           const PixelSampling& sampling);

 private:
  struct Light {
    explicit Light(const gl::ProgramPtr& p);
    gl::ProgramPtr program;
    SampleSumUniforms sums;
    gl::Uniform<std::uint32_t> pixel_count;
    gl::Uniform<float> share, kept_frames, all_rests;
    gl::Uniform<glm::mat4> previous_clip_from_world;
  };
  bool refracts(const DeviceScene& scene) const { return kind_ == Kind::kClearSurfaces && scene.has_clear_volumes(); }
  gl::Defines defines(const DeviceScene& scene) const;
  void sample_surfaces(const FrameContext& frame, const PixelSampling& sampling, const PatchGrid& grid);
  void meet_hits(const FrameContext& frame, const PixelSampling& sampling, const PatchGrid& grid);
  void clamp_fireflies(const FrameContext& frame, const PixelSampling& sampling, const PatchGrid& grid);
  void add_light(const FrameContext& frame, const Picture& picture, const PixelSampling& sampling,
                 const PatchGrid& grid);

  Kind kind_;
  gl::Defines defines_;
  gl::Variants<SurfaceSamplesProgram> surfaces_;
  gl::Variants<SampleHitsProgram> hits_;
  gl::Variants<Light> light_;
  ClearShadowsPass clear_shadows_;
  ClearSamplesPass clear_samples_;
  SmoothPathsPass smooth_paths_;
  SampleWave wave_;
  gl::BufferTexture list_texels_{"listed pixels", GL_R32UI};
  gl::BufferTexture state_texels_{"sample states", GL_RGBA32F}, light_texels_{"light of samples", GL_RGBA32F};
  gl::BufferTexture visible_texels_{"visible lights", GL_R32UI};
  gl::Buffer reflections_, reflections_before_;
  gl::BufferTexture before_texels_{"reflections before", GL_RGBA32UI};
};

}  // namespace lightwell
