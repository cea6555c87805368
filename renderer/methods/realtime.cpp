#include "renderer/methods/realtime.h"

#include <algorithm>

#include "renderer/passes/camera_block.h"
#include "renderer/passes/indirect_map_grid.h"

namespace lightwell {

namespace {

// The directions of a texel are spread over so many frames.
constexpr std::uint32_t kFramesOfSamples = 16;

// Fewer than one a frame: a patch of two or four texels has one, and each texel its turn.
glm::uvec2 log2_patch_of(std::uint32_t samples) {
  if (2 * samples > kFramesOfSamples) return {0, 0};
  return 4 * samples > kFramesOfSamples ? glm::uvec2(1, 0) : glm::uvec2(1, 1);
}

// While the cache is young all paths go on, to fill it; later one of four.
constexpr std::uint32_t kFillingFrames = 12, kPathStride = 4;

constexpr float kReflectionsInMotion = 4.0f;  // frames kept

constexpr float kGreatChange = 0.1f;  // of the light: the cache is filled anew

// After half of the light has changed, what was known before counts for a quarter of a frame: what it keeps of the
// light that is gone is 3 % of the light that is left after the next eight.
constexpr float kKeptAfterChange = 0.25f;

// What the history counts for, in frames. After motion it grows with the time since then, so that what has changed is
// forgotten; likewise with the age of the cache while this carries bounces, for its first frames hold too little light.
float frames_kept(const SceneChange& change, bool cache_carries, std::uint32_t since_motion, std::uint32_t age) {
  constexpr float kInMotion = 24.0f, kStill = 1024.0f, kOfTime = 0.5f, kOfAge = 0.25f;
  float most =
      change.moving ? kInMotion : std::min(kStill, 0.5f * kInMotion + kOfTime * static_cast<float>(since_motion));
  if (cache_carries) most = std::min(most, kOfAge * static_cast<float>(age + 1));
  return change.light_share > 0.0f ? std::min(most, kKeptAfterChange * left_over_gone(change.light_share)) : most;
}

bool clamps(const Settings& settings) {
  return settings.firefly_clamp > 0.0f && settings.bounces > 0;
}

}  // namespace

RealtimeMethod::RealtimeMethod(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : g_buffer_pass_(shaders),
      lights_(PlainSky::kLeftToRays),
      punctual_light_pass_(shaders, buffers),
      samples_pass_(shaders, buffers),
      firefly_clamp_pass_(shaders),
      cache_(shaders),
      reconstruction_pass_(shaders),
      compose_pass_(shaders),
      unmatched_pass_(shaders, buffers, PixelSamplesPass::Kind::kUnmatched),
      reflections_pass_(shaders, buffers, PixelSamplesPass::Kind::kReflections),
      front_(shaders, buffers),
      antialiasing_pass_(shaders),
      history_view_pass_(shaders) {}

const Picture& RealtimeMethod::render(FrameContext& frame, const Scene& scene, const PlacedCamera& camera,
                                      glm::vec2 jitter_px) {
  change_ = changes_.look_at(scene, frame.pose);
  if (change_.moving) moved_in_ = frame_number_;
  if (change_.light_share > kGreatChange) filled_from_ = frame_number_;
  lights_.prepare(scene, frame.pose);
  lights_.bind();
  motion_.follow(frame.pose, frame.trace_scene.device_positions);
  g_buffer_pass_.resize(frame.size_px);
  const GBuffer& g_buffer =
      g_buffer_pass_.run(frame.scene, frame.camera, frame.settings.seed + frame_number_, &motion_,
                         frame.scene.has_clear() ? GBufferLayer::kBehindClear : GBufferLayer::kAll);
  frame.timer.mark("g-buffer");
  const TracedLight& direct = punctual_light_pass_.run(frame, g_buffer, lights_, frame_number_);
  // With this frame's jitter, so that what stands still is found exactly where it was.
  const auto clip_from_world = [&](const PlacedCamera& c) {
    return make_camera_block(c, frame.size_px, jitter_px).clip_from_world;
  };
  const glm::mat4 previous_clip_from_world = clip_from_world(frame_number_ > 0 ? previous_camera_ : camera);
  all_rests_ = clip_from_world(camera) == previous_clip_from_world && !change_.moving;
  const ReconstructedMap indirect = indirect_light(frame, g_buffer, previous_clip_from_world);
  const Picture& composed = compose(frame, g_buffer, direct, indirect, previous_clip_from_world);
  const Picture& picture =
      over_time(frame, composed, g_buffer, previous_clip_from_world, all_rests_ && change_.light_share == 0.0f);
  previous_camera_ = camera;
  ++frame_number_;
  return picture;
}

const Picture& RealtimeMethod::compose(FrameContext& frame, const GBuffer& g_buffer, const TracedLight& direct,
                                       const ReconstructedMap& indirect, const glm::mat4& previous_clip_from_world) {
  const Settings& settings = frame.settings;
  compose_pass_.resize(g_buffer.depth);
  const bool accumulate = frame.accumulate && !settings.temporal_antialiasing;
  if (HistoryViewPass::shows(settings.view)) {
    const gl::Texture& shown =
        history_view_pass_.run(g_buffer, frame.scene, indirect, cache_, previous_clip_from_world, settings.view);
    const Picture& picture = compose_pass_.show(frame.scene, g_buffer, shown, settings, accumulate);
    frame.timer.mark("compose");
    return picture;
  }
  const bool layered = frame.scene.has_clear();
  const bool has_rays = settings.bounces > 0 && settings.view != ViewKind::kDirect;
  pixel_lists_.resize(frame.size_px);
  pixel_lists_.begin();
  const Picture& picture =
      compose_pass_.run(frame.scene, g_buffer, direct, indirect, has_rays ? &pixel_lists_ : nullptr, frame_number_,
                        settings, accumulate && !layered);
  frame.timer.mark("compose");
  // Images in mirrors move by themselves: nothing tells where they were.
  const float kept = change_.moving ? std::min(kept_frames(settings), kReflectionsInMotion) : kept_frames(settings);
  const PixelSampling sampling{g_buffer,
                               lights_,
                               cache_,
                               indirect,
                               previous_clip_from_world,
                               kept,
                               all_rests_,
                               frame_number_,
                               clamps(settings) ? &firefly_clamp_pass_ : nullptr};
  if (has_rays) {
    pixel_lists_.count();
    unmatched_pass_.run(frame, picture, pixel_lists_.unmatched(), pixel_lists_.unmatched_count(), sampling);
    reflections_pass_.run(frame, picture, pixel_lists_.reflecting(), pixel_lists_.reflecting_count(), sampling);
  }
  return layered ? front_.run(frame, picture, sampling, has_rays, accumulate) : picture;
}

float RealtimeMethod::kept_frames(const Settings& settings) const {
  return frames_kept(change_, settings.bounces > 2, frame_number_ - moved_in_, frame_number_ - filled_from_);
}

const Picture& RealtimeMethod::over_time(FrameContext& frame, const Picture& composed, const GBuffer& g_buffer,
                                         const glm::mat4& previous_clip_from_world, bool unchanged) {
  if (!frame.settings.temporal_antialiasing) {
    antialiasing_pass_.forget();
    return composed;
  }
  antialiasing_pass_.resize(frame.size_px);
  const bool accumulates = frame.accumulate && frame.frame_number > 0;
  const Picture& picture = accumulates
                               ? antialiasing_pass_.refine(composed, frame.frame_number)
                               : antialiasing_pass_.blend(composed, g_buffer, previous_clip_from_world, unchanged);
  frame.timer.mark("anti-aliasing");
  return picture;
}

PatchGrid RealtimeMethod::grid_of(const FrameContext& frame) const {
  PatchGrid grid;
  grid.map_size_px = indirect_map_size(frame.size_px, frame.settings.indirect_size);
  grid.picture_size_px = frame.size_px;
  const auto samples = static_cast<std::uint32_t>(frame.settings.samples);
  grid.rays_per_texel = std::max(1u, samples / kFramesOfSamples);
  grid.log2_patch = log2_patch_of(samples);
  grid.frame_number = frame_number_;
  grid.seed = frame.settings.seed;
  return grid;
}

ReconstructedMap RealtimeMethod::indirect_light(FrameContext& frame, const GBuffer& g_buffer,
                                                const glm::mat4& previous_clip_from_world) {
  const PatchGrid grid = grid_of(frame);
  samples_pass_.resize(grid, clamps(frame.settings));
  reconstruction_pass_.resize(grid.map_size_px);
  if (!clamps(frame.settings)) firefly_clamp_pass_.forget();
  if (frame.settings.bounces == 0) return reconstruction_pass_.nothing();
  cache_.begin_frame(frame.pose, change_);
  // Of fewer rays more go on, for the cache would not know light that has bounced twice where it is asked for it.
  const std::uint32_t stride =
      frame_number_ - filled_from_ < kFillingFrames ? 1 : std::max(1u, kPathStride / grid.frames_of_patch());
  const PatchSamples& samples = samples_pass_.run(frame, g_buffer, lights_, cache_, grid, stride);
  if (clamps(frame.settings))
    firefly_clamp_pass_.run_over_map(frame, g_buffer, samples, grid, kept_frames(frame.settings));
  // A texel's frames are those in which it has had rays.
  const float kept = kept_frames(frame.settings) / static_cast<float>(grid.frames_of_patch());
  const ReconstructedMap map =
      reconstruction_pass_.run(g_buffer, frame.scene, samples, grid, previous_clip_from_world, kept);
  frame.timer.mark("reconstruction");
  return map;
}

}  // namespace lightwell
