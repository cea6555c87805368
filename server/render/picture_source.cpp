#include "server/render/picture_source.h"

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
    return renderer_.render(scene, request, view);
  }

 private:
  Renderer renderer_;
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

}  // namespace lightwell
