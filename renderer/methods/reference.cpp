#include "renderer/methods/reference.h"

namespace lightwell {

ReferenceMethod::ReferenceMethod(gl::ShaderLibrary& shaders, gl::BufferUse buffers) : path_tracer_(shaders, buffers) {}

const Picture& ReferenceMethod::render(FrameContext& frame, const Scene& scene) {
  lights_.prepare(scene, frame.pose);
  lights_.bind();
  frame.timer.mark("lights");
  path_tracer_.resize(frame.size_px);
  return path_tracer_.run(frame, scene, lights_);
}

}  // namespace lightwell
