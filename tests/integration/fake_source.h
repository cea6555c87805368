// Pictures without a graphics device: a source that paints one colour, as slowly as a test wants, and keeps account.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "server/render/picture_source.h"

namespace lightwell::test {

/// What the source does and has done; shared with the test, which may look and change at any time.
struct FakeStudio {
  std::atomic<int> render_ms = 1;
  std::atomic<bool> held = false;  // a picture that has been begun is finished only when this is over
  std::atomic<bool> failing = false;
  std::atomic<bool> throwing = false;
  std::atomic<bool> losing = false;        // the device: once
  std::atomic<bool> lost = false;          // whenever it is asked
  std::atomic<int> sources = 0;            // made
  std::atomic<int> views = 0;              // alive
  std::atomic<int> begun = 0;              // pictures
  std::atomic<int> pictures = 0;           // and finished
  std::atomic<int> given_up = 0;           // or not: an input came
  std::atomic<int> given_up_in_a_row = 0;  // at most

  std::vector<glm::ivec2> sizes_to_warm_up;  // set before the source is made

  std::vector<FrameRequest> requests() const {
    std::lock_guard lock(mutex);
    return log;
  }

  /// Waits until no picture has been made for a while; false if that never comes.
  bool comes_to_rest() const {
    int last = -1;
    for (int i = 0; i < 300; ++i) {
      if (std::exchange(last, pictures.load()) == pictures) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    return false;
  }

  mutable std::mutex mutex;
  std::vector<FrameRequest> log;
};

class FakeSource : public PictureSource {
 public:
  explicit FakeSource(std::shared_ptr<FakeStudio> studio) : studio_(std::move(studio)) { ++studio_->sources; }

  SourceFacts facts() override { return {"a fake device", "a test", "none", {"thesis", "realtime"}}; }

  gl::DeviceMemory memory() override { return {3000, 2000, 1000}; }

  std::vector<glm::ivec2> sizes_to_warm_up() override { return studio_->sizes_to_warm_up; }

  std::unique_ptr<RenderView> make_view() override { return std::make_unique<View>(studio_); }

  Result<Frame> render(const Scene&, const FrameRequest& request, RenderView& render_view) override {
    auto& view = static_cast<View&>(render_view);
    ++studio_->begun;
    if (is_given_up(request)) {
      ++studio_->given_up;
      studio_->given_up_in_a_row = std::max(studio_->given_up_in_a_row.load(), ++in_a_row_);
      return Error{ErrorKind::kUnwanted, "", "given up"};
    }
    in_a_row_ = 0;
    if (studio_->losing.exchange(false) || studio_->lost)
      return Error{ErrorKind::kDeviceLost, "", "the fake device is lost"};
    if (studio_->throwing) throw std::runtime_error("the fake source was told to throw");
    if (studio_->failing) return Error{ErrorKind::kUnsupported, "scene", "the fake source was told to fail"};
    ++studio_->pictures;
    {
      std::lock_guard lock(studio_->mutex);
      studio_->log.push_back(request);
    }
    view.accumulated = request.accumulate ? view.accumulated + 1 : 1;
    return paint(request, view.accumulated);
  }

 private:
  struct View : RenderView {
    explicit View(std::shared_ptr<FakeStudio> shared) : studio(std::move(shared)) { ++studio->views; }
    ~View() override { --studio->views; }
    std::shared_ptr<FakeStudio> studio;
    std::uint32_t accumulated = 0;
  };

  /// Takes its time, unless nobody wants the picture any more.
  bool is_given_up(const FrameRequest& request) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(studio_->render_ms);
    while (studio_->held || std::chrono::steady_clock::now() < end) {
      if (request.is_unwanted && request.is_unwanted()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }

  Frame paint(const FrameRequest& request, std::uint32_t accumulated) const {
    Frame frame;
    frame.size_px = request.size_px;
    frame.accumulated = accumulated;
    const auto pixels = static_cast<std::size_t>(request.size_px.x) * static_cast<std::size_t>(request.size_px.y);
    if (request.want_display) frame.display_rgbx.assign(pixels * 4, static_cast<std::uint8_t>(50 + accumulated));
    if (request.want_linear) frame.linear_rgb.assign(pixels * 3, 0.5f);
    frame.stages = {{"shadow maps", 0.25}, {"trace", 0.5}};
    frame.total_ms = studio_->render_ms;
    frame.rays = pixels;
    frame.clamped_share = 0.125f;
    return frame;
  }

  std::shared_ptr<FakeStudio> studio_;
  int in_a_row_ = 0;
};

inline MakePictureSource fake_source(std::shared_ptr<FakeStudio> studio) {
  return [studio] { return std::make_unique<FakeSource>(studio); };
}

}  // namespace lightwell::test
