// The clear surfaces that the camera looks through, of the realtime method: the nearest of each pixel with the light it
// sends back, over what is behind all of them.
#pragma once

#include "renderer/methods/frame_context.h"
#include "renderer/passes/clear_layers.h"
#include "renderer/passes/compose.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/pixel_lists.h"
#include "renderer/passes/pixel_samples.h"
#include "renderer/passes/punctual_light.h"

namespace lightwell {

class RealtimeFront {
 public:
  /// `buffers`: where rays and hits live; host-visible for a native tracer.
  RealtimeFront(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// `sampling` is that of what is behind, with its G-buffer. `reflects`: light that bounces counts.
  const Picture& run(FrameContext& frame, const Picture& behind, const PixelSampling& sampling, bool reflects,
                     bool accumulate);

 private:
  GBufferPass g_buffer_pass_;
  ClearLayersPass layers_pass_;
  PunctualLightPass punctual_light_pass_;
  ComposePass compose_pass_;
  PixelLists pixel_lists_;
  PixelSamplesPass reflections_pass_;
};

}  // namespace lightwell
