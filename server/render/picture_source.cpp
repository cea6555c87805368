#include "server/render/picture_source.h"

#include <atomic>
#include <cstdlib>
#include <string_view>

#include "renderer/gl/gl.h"
#include "renderer/tracing/embree/embree_tracer.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {
namespace {

class RendererSource : public PictureSource {
 public:
  explicit RendererSource(const RendererOptions& options) : renderer_(options) {}

  SourceFacts facts() override {
    SourceFacts facts;
    facts.device = renderer_.context().device().gl_renderer;
    facts.device_why = renderer_.context().why();
    facts.tracer = renderer_.tracer_name();
    for (const Method method : {Method::kThesis, Method::kRealtime, Method::kReference}) {
      Settings settings;
      settings.method = method;
      if (check_settings(settings, {64, 64})) facts.methods.emplace_back(name_of(method));
    }
    return facts;
  }

  std::unique_ptr<RenderView> make_view() override { return renderer_.make_view(); }

  Result<Frame> render(const Scene& scene, const FrameRequest& request, RenderView& view) override {
    Result<Frame> frame = renderer_.render(scene, request, view);
    if (const char* why = device_loss()) return Error{ErrorKind::kDeviceLost, "", why};
    return frame;
  }

  gl::DeviceMemory memory() override { return gl::device_memory(); }

  /// llvmpipe compiles a shader anew for every texture whose width or height is a power of two where it was none
  /// before, or the other way round: seconds and megabytes, in the middle of a stream, when a window changes its size
  /// or a busy machine gives up resolution. Here are pictures, indirect maps and patches with such sides and without.
  std::vector<glm::ivec2> sizes_to_warm_up() override {
    if (!renderer_.context().device().software) return {};
    return {{160, 96}, {200, 200}, {72, 40}, {256, 256}};
  }

 private:
  /// What the device says of itself after a frame; null: nothing bad.
  static const char* device_loss() {
    if (glGetGraphicsResetStatus() != GL_NO_ERROR) return "the graphics context was reset";
    constexpr GLenum kContextLost = 0x0507;
    for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError()) {
      if (error == kContextLost) return "the graphics context was lost";
      if (error == GL_OUT_OF_MEMORY) return "the graphics device has no memory left";
    }
    return nullptr;
  }

  Renderer renderer_;
};

/// Loses its device once, after so many frames of this and earlier ones. Warms nothing up: whoever counts frames means
/// those that were asked for.
class FaultySource : public PictureSource {
 public:
  FaultySource(std::unique_ptr<PictureSource> source, std::shared_ptr<std::atomic<int>> frames_left)
      : source_(std::move(source)), frames_left_(std::move(frames_left)) {}

  SourceFacts facts() override { return source_->facts(); }
  std::unique_ptr<RenderView> make_view() override { return source_->make_view(); }
  gl::DeviceMemory memory() override { return source_->memory(); }
  Result<Frame> render(const Scene& scene, const FrameRequest& request, RenderView& view) override {
    if ((*frames_left_)-- == 0) return Error{ErrorKind::kDeviceLost, "", "LIGHTWELL_FAULT says so"};
    return source_->render(scene, request, view);
  }

 private:
  std::unique_ptr<PictureSource> source_;
  std::shared_ptr<std::atomic<int>> frames_left_;
};

}  // namespace

MakePictureSource renderer_source(const std::string& device, const std::string& tracer) {
  return [device, tracer]() -> std::unique_ptr<PictureSource> {
    RendererOptions options;
    options.device.request = device;
    options.tracer = tracer;
    options.make_native_tracer = [] { return make_embree_tracer(); };
    return std::make_unique<RendererSource>(options);
  };
}

MakePictureSource with_fault(MakePictureSource make_source, const char* fault) {
  constexpr std::string_view kDeviceLost = "device-lost@";
  if (!fault || !std::string_view(fault).starts_with(kDeviceLost)) return make_source;
  const auto frames_left = std::make_shared<std::atomic<int>>(std::atoi(fault + kDeviceLost.size()));
  return [make_source = std::move(make_source), frames_left] {
    return std::make_unique<FaultySource>(make_source(), frames_left);
  };
}

}  // namespace lightwell
