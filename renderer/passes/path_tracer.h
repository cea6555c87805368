// A wavefront path tracer over the tracers' seam: all paths of a wave meet their surfaces in one dispatch, then all
// shadow rays and all next rays are traced, and those that hit something are the next dispatch.
#pragma once

#include <memory>

#include "renderer/methods/frame_context.h"
#include "renderer/passes/clear_shadows.h"
#include "renderer/passes/compose.h"
#include "renderer/passes/light_table.h"
#include "renderer/passes/photon_guides.h"

namespace lightwell {

class PathTracerPass {
 public:
  /// `buffers`: where rays and hits live; host-visible for a native tracer.
  PathTracerPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);
  ~PathTracerPass();

  void resize(glm::ivec2 size_px);

  /// Adds one path per pixel to the picture, or begins it anew if `frame.frame_number` is 0. The number is the sample's
  /// index in each pixel's sequences.
  const Picture& run(FrameContext& frame, const Scene& scene, const LightTable& lights);

 private:
  struct Wave {  // rows of the picture
    int first_row = 0, rows = 0;
    std::uint32_t first_pixel = 0, paths = 0;
  };
  struct Programs;
  struct SurfaceVariant;
  struct Slots;

  gl::Defines defines_for(const DeviceScene& scene, const LightTable& lights) const;
  void trace_wave(FrameContext& frame, const LightTable& lights, const Wave& wave);
  void start(const FrameContext& frame, const Wave& wave);
  void meet_surfaces(const SurfaceVariant& vertex, std::uint32_t paths);
  void end_rays(const SurfaceVariant& end, std::uint32_t paths);
  std::uint32_t count_hits() const;
  void accumulate(const FrameContext& frame, const Wave& wave);

  std::unique_ptr<Programs> programs_;
  std::unique_ptr<Slots> slots_;
  ClearShadowsPass clear_shadows_;
  PhotonGuidesPass guides_;
  std::uint32_t most_paths_;  // in a wave
  Picture picture_;
  gl::Framebuffer framebuffer_;
  gl::EmptyVertexArray full_screen_;
};

}  // namespace lightwell
