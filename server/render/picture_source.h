// What makes pictures, as the render loop sees it: a Renderer, or a stand-in for tests.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderer/gl/memory.h"
#include "renderer/renderer.h"

namespace lightwell {

/// What pictures are made with, for people and for clients.
struct SourceFacts {
  std::string device;      // GL_RENDERER
  std::string device_why;  // why this one was chosen
  std::string tracer;
  std::vector<std::string> methods;  // what Settings::method may be
};

/// Made, used and destroyed on one thread.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  virtual SourceFacts facts() = 0;
  virtual std::unique_ptr<RenderView> make_view() = 0;
  virtual Result<Frame> render(const Scene& scene, const FrameRequest& request, RenderView& view) = 0;
  virtual gl::DeviceMemory memory() { return {}; }
  /// Pictures of these sizes, once made, spare later ones of any size that the device compiles shaders for them. The
  /// most wanted first.
  virtual std::vector<glm::ivec2> sizes_to_warm_up() { return {}; }
};

/// Called on the render thread. Throws as Renderer's constructor does.
using MakePictureSource = std::function<std::unique_ptr<PictureSource>()>;

/// The renderer of this project, with Embree as its native tracer.
MakePictureSource renderer_source(const std::string& device, const std::string& tracer);

/// For tests of what must never happen: with a `fault` of "device-lost@N" the device is lost once, after N frames.
/// Null, or anything else: `make_source` as it is.
MakePictureSource with_fault(MakePictureSource make_source, const char* fault);

}  // namespace lightwell
