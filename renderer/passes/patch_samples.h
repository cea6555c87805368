// The occlusion map of `realtime`: rays from one real pixel of each patch, hit records, and the light that leaves the
// hits, by samples of the lights with traced shadow rays and by the radiance cache.
#pragma once

#include <memory>

#include "renderer/methods/frame_context.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/light_table.h"
#include "renderer/passes/patch_grid.h"
#include "renderer/passes/radiance_cache.h"

namespace lightwell {

/// What passes/patch_light.frag sums up.
struct PatchSamples {
  gl::BufferTexture states{"sample states", GL_RGBA32F};
  gl::BufferTexture light{"light of samples", GL_RGBA32F};
  const gl::Buffer* light_buffer = nullptr;  // the same
  gl::BufferTexture visible{"visible lights", GL_R32UI};
  gl::BufferTexture next_states{"next states", GL_RGBA32F};
  gl::BufferTexture next_light{"light of next hits", GL_RGBA32F};
  std::uint32_t path_stride = 1, path_phase = 0;  // which rays' paths went on beyond their hits
  std::uint32_t first_next = 0;                   // and the place of the first of them
  bool lamps_sampled = false;                     // lights with a size were sampled at the pixels themselves

  /// Where shaders/sum_samples.glsl reads them.
  void bind() const;
};

class PatchSamplesPass {
 public:
  /// `buffers`: where rays and hits live; host-visible for a native tracer.
  PatchSamplesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);
  ~PatchSamplesPass();

  /// `tells_direct`: what has not bounced lies behind the light of the lamps, see first_direct().
  void resize(const PatchGrid& grid, bool tells_direct);

  /// `lights` is bound. Paths go on from one of `path_stride` hits. Bounces 1 and 2 end where they say; from 3 on the
  /// cache carries all that follow.
  const PatchSamples& run(FrameContext& frame, const GBuffer& g_buffer, const LightTable& lights, RadianceCache& cache,
                          const PatchGrid& grid, std::uint32_t path_stride);

 private:
  struct Programs;
  struct Slots;
  void sample_surfaces(const FrameContext& frame, const GBuffer& g_buffer, const LightTable& lights,
                       const PatchGrid& grid);
  struct Meeting;
  void meet_hits(const FrameContext& frame, const LightTable& lights, const RadianceCache& cache, const PatchGrid& grid,
                 const Meeting& meeting);
  void follow_paths(FrameContext& frame, const LightTable& lights, RadianceCache& cache, const PatchGrid& grid);

  std::unique_ptr<Programs> programs_;
  std::unique_ptr<Slots> slots_;
  PatchSamples samples_;
};

}  // namespace lightwell
