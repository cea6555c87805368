#include "renderer/methods/realtime_front.h"

namespace lightwell {

RealtimeFront::RealtimeFront(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : g_buffer_pass_(shaders),
      layers_pass_(shaders),
      punctual_light_pass_(shaders, buffers),
      compose_pass_(shaders),
      reflections_pass_(shaders, buffers, PixelSamplesPass::Kind::kClearSurfaces) {}

const Picture& RealtimeFront::run(FrameContext& frame, const Picture& behind, const PixelSampling& sampling,
                                  bool reflects, bool accumulate) {
  g_buffer_pass_.resize(frame.size_px);
  layers_pass_.resize(frame.size_px);
  const gl::Texture& layers = layers_pass_.run(frame.scene, sampling.g_buffer);
  const GBuffer& g_buffer = g_buffer_pass_.run(frame.scene, frame.camera, frame.settings.seed + sampling.frame_number,
                                               nullptr, GBufferLayer::kClearAlone);
  frame.timer.mark("g-buffer");
  const TracedLight& direct = punctual_light_pass_.run(frame, g_buffer, sampling.lights, sampling.frame_number);
  compose_pass_.resize(g_buffer.depth);
  pixel_lists_.resize(frame.size_px);
  pixel_lists_.begin();
  const Picture& picture = compose_pass_.run_over({behind, layers}, frame.scene, g_buffer, direct,
                                                  reflects ? &pixel_lists_ : nullptr, frame.settings, accumulate);
  frame.timer.mark("compose");
  if (!reflects) return picture;
  pixel_lists_.count();
  const PixelSampling of_front{g_buffer,
                               sampling.lights,
                               sampling.cache,
                               sampling.map,
                               sampling.previous_clip_from_world,
                               sampling.kept_frames,
                               sampling.all_rests,
                               sampling.frame_number,
                               sampling.firefly_clamp};
  reflections_pass_.run(frame, picture, pixel_lists_.reflecting(), pixel_lists_.reflecting_count(), of_front);
  return picture;
}

}  // namespace lightwell
