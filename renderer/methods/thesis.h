// The method of the thesis: occlusion maps as indirect light sources, further bounces in screen space.
#pragma once

#include "renderer/methods/frame_context.h"
#include "renderer/passes/active_blocks.h"
#include "renderer/passes/clear_hits.h"
#include "renderer/passes/clear_layers.h"
#include "renderer/passes/compose.h"
#include "renderer/passes/directions.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/gather.h"
#include "renderer/passes/hit_light.h"
#include "renderer/passes/host_gather.h"
#include "renderer/passes/patches.h"
#include "renderer/passes/shadow_maps.h"

namespace lightwell {

class ThesisMethod {
 public:
  /// `buffers`: where rays and hits live; host-visible for a native tracer.
  ThesisMethod(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// One frame. The camera and environment blocks and the scene are bound.
  const Picture& render(FrameContext& frame);

 private:
  struct ScreenLight {  // where bounces after the first find their light
    const GBuffer& g_buffer;
    const gl::Texture& map;
  };
  const Picture& render_layers(FrameContext& frame);
  void resize(const FrameContext& frame, const IndirectMapGrid& grid);
  void resize_maps(const IndirectMapGrid& grid);
  const IndirectMap& indirect_light(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                                    const IndirectMapGrid& grid);
  void find_patches(FrameContext& frame, const GBuffer& g_buffer, const IndirectMapGrid& grid);
  Directions& trace_batch(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                          const IndirectMapGrid& grid, std::uint32_t first, std::uint32_t batch);
  void trace(FrameContext& frame, const Directions& directions);
  void trace_candidates(FrameContext& frame, const Directions& directions);
  void gather_on_host(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                      const IndirectMapGrid& grid);
  void gather_bounce(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                     const IndirectMapGrid& grid, const ScreenLight* screen);
  const Picture& clear_surfaces_over(const Picture& behind, FrameContext& frame, const GBuffer& g_buffer,
                                     const ShadowMaps& shadows, const IndirectMapGrid& grid);
  const IndirectMap& reflected_by_clear(FrameContext& frame, const GBuffer& front, const GBuffer& g_buffer,
                                        const ShadowMaps& shadows, const IndirectMapGrid& grid);

  GBufferPass g_buffer_pass_;
  ShadowMapsPass shadow_maps_pass_;
  ActiveBlocksPass active_blocks_pass_;
  PatchesPass patches_pass_;
  DirectionsPass directions_pass_;
  ClearHitsPass clear_hits_pass_;
  HitLightPass hit_light_pass_;
  HostGatherPass host_gather_pass_;
  GatherPass gather_pass_;
  IndirectFilterPass filter_pass_;
  AddMapsPass add_maps_pass_;
  MapViewPass map_view_pass_;
  ComposePass compose_pass_;
  OcclusionMap occlusion_;
  gl::Buffer candidates_, candidates_of_group_;  // Hit
  IndirectMap bounce_, previous_bounce_, all_bounces_;
  GBufferPass clear_g_buffer_pass_;  // of scenes with clear surfaces, as the rest of these
  ClearLayersPass clear_layers_pass_;
  ComposePass clear_compose_pass_;
  IndirectMap seen_light_;                       // what bounces light clear surfaces
  const ActiveBlocks* active_blocks_ = nullptr;  // of this frame
  const Patches* patches_ = nullptr;             // of this frame
  Directions* traced_ = nullptr;                 // the batch whose hits are in occlusion_; null: none of this frame
};

}  // namespace lightwell
