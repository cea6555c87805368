// The truth to hold the other methods against: unbiased path tracing, one path per pixel and frame, accumulated.
#pragma once

#include "renderer/methods/frame_context.h"
#include "renderer/passes/light_table.h"
#include "renderer/passes/path_tracer.h"

namespace lightwell {

class ReferenceMethod {
 public:
  /// `buffers`: where rays and hits live; host-visible for a native tracer.
  ReferenceMethod(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// One frame: final, direct or indirect light. The camera and environment blocks and the scene are bound.
  const Picture& render(FrameContext& frame, const Scene& scene);

 private:
  LightTable lights_;
  PathTracerPass path_tracer_;
};

}  // namespace lightwell
