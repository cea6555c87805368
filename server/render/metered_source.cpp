#include "server/render/metered_source.h"

#include <chrono>
#include <utility>

namespace lightwell {
namespace {

using std::chrono::steady_clock;

constexpr auto kBetweenLooks = std::chrono::seconds(1);

class MeteredSource : public PictureSource {
 public:
  MeteredSource(std::unique_ptr<PictureSource> source, Metrics& metrics)
      : source_(std::move(source)), metrics_(metrics) {}

  SourceFacts facts() override { return source_->facts(); }
  std::unique_ptr<RenderView> make_view() override { return source_->make_view(); }
  gl::DeviceMemory memory() override { return source_->memory(); }
  std::vector<glm::ivec2> sizes_to_warm_up() override { return source_->sizes_to_warm_up(); }

  Result<Frame> render(const Scene& scene, const FrameRequest& request, RenderView& view) override {
    Result<Frame> frame = source_->render(scene, request, view);
    const auto now = steady_clock::now();
    if (frame && now - looked_at_ >= kBetweenLooks) {
      looked_at_ = now;
      metrics_.device_memory(source_->memory());
    }
    return frame;
  }

 private:
  const std::unique_ptr<PictureSource> source_;
  Metrics& metrics_;
  steady_clock::time_point looked_at_{};
};

}  // namespace

MakePictureSource with_memory_meter(MakePictureSource make_source, Metrics& metrics) {
  return [make_source = std::move(make_source), &metrics] {
    return std::make_unique<MeteredSource>(make_source(), metrics);
  };
}

}  // namespace lightwell
