// Global illumination of fully dynamic scenes at a rate to work with: an occlusion map of one real pixel per patch,
// lights sampled with traced shadow rays, further bounces from a radiance cache in the world, and reuse of earlier
// frames.
#pragma once

#include "renderer/methods/frame_budget.h"
#include "renderer/methods/frame_context.h"
#include "renderer/methods/realtime_front.h"
#include "renderer/passes/compose.h"
#include "renderer/passes/firefly_clamp.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/history_view.h"
#include "renderer/passes/instance_motion.h"
#include "renderer/passes/light_table.h"
#include "renderer/passes/patch_samples.h"
#include "renderer/passes/pixel_lists.h"
#include "renderer/passes/pixel_samples.h"
#include "renderer/passes/punctual_light.h"
#include "renderer/passes/radiance_cache.h"
#include "renderer/passes/reconstruction.h"
#include "renderer/passes/scene_changes.h"
#include "renderer/passes/temporal_antialiasing.h"

namespace lightwell {

class RealtimeMethod {
 public:
  /// `buffers`: where rays and hits live; host-visible for a native tracer.
  RealtimeMethod(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// What Settings::target_fps goes by: to be asked before a frame, and told after it.
  FrameBudget& budget() { return budget_; }

  /// Of all indirect light of the frames before, as much as the history keeps of each, the share that
  /// Settings::firefly_clamp has taken away, 0 to 1. Once the device has done the frame.
  float clamped_share() const { return firefly_clamp_pass_.share(); }

  /// The number of the next frame: how its picture is to be shifted.
  std::uint32_t frame_number() const { return frame_number_; }

  /// One frame, with what is known of the frames before. The camera and environment blocks and the scene are bound; the
  /// picture is moved by `jitter_px` of a pixel.
  const Picture& render(FrameContext& frame, const Scene& scene, const PlacedCamera& camera, glm::vec2 jitter_px);

 private:
  ReconstructedMap indirect_light(FrameContext& frame, const GBuffer& g_buffer,
                                  const glm::mat4& previous_clip_from_world);
  const Picture& compose(FrameContext& frame, const GBuffer& g_buffer, const TracedLight& direct,
                         const ReconstructedMap& indirect, const glm::mat4& previous_clip_from_world);
  float kept_frames(const Settings& settings) const;
  const Picture& over_time(FrameContext& frame, const Picture& composed, const GBuffer& g_buffer,
                           const glm::mat4& previous_clip_from_world, bool unchanged);
  PatchGrid grid_of(const FrameContext& frame) const;

  FrameBudget budget_;
  GBufferPass g_buffer_pass_;
  LightTable lights_;
  PunctualLightPass punctual_light_pass_;
  PatchSamplesPass samples_pass_;
  FireflyClampPass firefly_clamp_pass_;
  RadianceCache cache_;
  ReconstructionPass reconstruction_pass_;
  ComposePass compose_pass_;
  PixelLists pixel_lists_;
  PixelSamplesPass unmatched_pass_, reflections_pass_;
  RealtimeFront front_;
  TemporalAntialiasingPass antialiasing_pass_;
  HistoryViewPass history_view_pass_;
  InstanceMotion motion_;
  SceneChanges changes_;
  SceneChange change_;      // in this frame
  bool all_rests_ = false;  // neither the camera nor anything in the scene has moved since the last frame
  std::uint32_t frame_number_ = 0;
  std::uint32_t filled_from_ = 0;                     // when the cache began to be filled
  std::uint32_t moved_in_ = std::uint32_t{0} - 4096;  // when something moved last
  PlacedCamera previous_camera_;
};

}  // namespace lightwell
