// How the render thread shares its time out among those it renders for.
#include "server/render/render_loop.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/integration/fake_source.h"
#include "tests/integration/line.h"

namespace lightwell::test {
namespace {

using std::chrono::steady_clock;

/// Wants pictures without end. Knows how much time its pictures took.
class Greedy : public Subject {
 public:
  /// Takes the device for `extra_ms` more than a picture of the source does.
  explicit Greedy(int extra_ms) : extra_(extra_ms), scene_(std::make_shared<const Scene>()) {}

  SteadyTime due_at(SteadyTime now) override { return now; }
  Result<Shot> take_shot(SteadyTime now) override {
    start_ = now;
    std::this_thread::sleep_for(extra_);
    Shot shot;
    shot.scene = scene_;
    shot.request.size_px = {1, 1};
    return shot;
  }
  void shot_done(Result<Frame>) override {
    const std::chrono::duration<double> took = steady_clock::now() - start_;
    longest_s = std::max(longest_s.load(), took.count());
    used_s = used_s + took.count();
  }
  bool ended() const override { return satisfied; }

  std::atomic<bool> satisfied = false;
  std::atomic<double> used_s = 0.0, longest_s = 0.0;

 private:
  const std::chrono::milliseconds extra_;
  const std::shared_ptr<const Scene> scene_;
  SteadyTime start_{};
};

/// Wants one every tenth of a second.
class Unhurried final : public Greedy {
 public:
  using Greedy::Greedy;
  SteadyTime due_at(SteadyTime) override { return due_; }
  void shot_done(Result<Frame> frame) override {
    Greedy::shot_done(std::move(frame));
    due_ = steady_clock::now() + std::chrono::milliseconds(100);
  }

 private:
  SteadyTime due_{};
};

std::unique_ptr<RenderLoop> fake_loop(std::shared_ptr<FakeStudio> studio = std::make_shared<FakeStudio>()) {
  const auto warm_up = [] {
    Shot shot;
    shot.scene = std::make_shared<const Scene>();
    shot.request.size_px = {1, 1};
    return shot;
  };
  auto loop =
      std::make_unique<RenderLoop>(fake_source(std::move(studio)), warm_up, [](Share, const Result<Frame>&, double) {});
  loop->ready().wait();
  return loop;
}

TEST(RenderLoop, GivesEverySessionItsShareAndAllRequestsOneTogether) {
  const auto loop = fake_loop();
  const auto light = std::make_shared<Greedy>(0), heavy = std::make_shared<Greedy>(15);
  std::vector<std::shared_ptr<Greedy>> requests;
  for (int i = 0; i < 3; ++i) requests.push_back(std::make_shared<Greedy>(5));
  loop->add(light, Share::kOwn);
  loop->add(heavy, Share::kOwn);
  for (const auto& request : requests) loop->add(request, Share::kJobs);
  EXPECT_TRUE(comes_true([&] { return light->used_s + heavy->used_s > 1.0; }));
  loop->stop();

  double of_requests_s = 0.0, longest_s = std::max(light->longest_s.load(), heavy->longest_s.load());
  for (const auto& request : requests) {
    of_requests_s += request->used_s;
    longest_s = std::max(longest_s, request->longest_s.load());
  }
  // Who has had least goes first: nobody is ever further ahead than by one picture, whatever else the machine does.
  EXPECT_LE(std::abs(light->used_s - heavy->used_s), 2.0 * longest_s);
  EXPECT_LE(std::abs(light->used_s - of_requests_s), 2.0 * longest_s);
}

TEST(RenderLoop, ALookOfOnesOwnTakesFromItsSessionsShare) {
  const auto loop = fake_loop();
  const auto account = RenderLoop::make_account();
  const auto alone = std::make_shared<Greedy>(2), driver = std::make_shared<Greedy>(2),
             look = std::make_shared<Greedy>(8);
  loop->add(alone, Share::kOwn);
  loop->add(driver, Share::kOwn, account);
  loop->add(look, Share::kOwn, account);
  EXPECT_TRUE(comes_true([&] { return alone->used_s > 0.5 && look->used_s > 0.1; }));
  loop->stop();
  const double longest_s = std::max({alone->longest_s.load(), driver->longest_s.load(), look->longest_s.load()});
  EXPECT_LE(std::abs(alone->used_s - (driver->used_s + look->used_s)), 2.0 * longest_s);
  EXPECT_LE(std::abs(driver->used_s - look->used_s), 2.0 * longest_s);
}

std::vector<glm::ivec2> sizes_of(const std::vector<FrameRequest>& requests) {
  std::vector<glm::ivec2> sizes;
  for (const FrameRequest& request : requests) sizes.push_back(request.size_px);
  return sizes;
}

TEST(RenderLoop, WarmsUpOnceWhatTheSourceAsksForWhenNobodyWaits) {
  const auto studio = std::make_shared<FakeStudio>();
  studio->sizes_to_warm_up = {{160, 96}, {72, 40}, {256, 256}};
  const auto loop = fake_loop(studio);
  const std::vector<glm::ivec2> all{{1, 1}, {160, 96}, {72, 40}, {256, 256}};  // after the first picture
  EXPECT_TRUE(comes_true([&] { return sizes_of(studio->requests()) == all; }));
  const auto greedy = std::make_shared<Greedy>(1);
  loop->add(greedy, Share::kOwn);
  EXPECT_TRUE(comes_true([&] { return greedy->used_s > 0.1; }));
  greedy->satisfied = true;
  EXPECT_TRUE(studio->comes_to_rest());
  loop->stop();
  const std::vector<glm::ivec2> sizes = sizes_of(studio->requests());
  EXPECT_EQ(std::count(sizes.begin() + 4, sizes.end(), glm::ivec2(1, 1)), std::ssize(sizes) - 4);
  EXPECT_EQ(studio->views, 0);  // and what they were made in is gone
}

void warms_up_only_after(const std::shared_ptr<Greedy>& subject) {
  const auto studio = std::make_shared<FakeStudio>();
  studio->sizes_to_warm_up = {{160, 96}};
  const auto loop = fake_loop(studio);
  const SteadyTime start = steady_clock::now();
  loop->add(subject, Share::kOwn);
  const std::chrono::seconds long_enough(4);  // it waits less before it begins
  EXPECT_TRUE(comes_true([&] { return steady_clock::now() - start > long_enough; }));
  std::vector<glm::ivec2> sizes = sizes_of(studio->requests());
  EXPECT_GT(sizes.size(), 3u);
  EXPECT_EQ(std::count(sizes.begin(), sizes.end(), glm::ivec2(160, 96)), 0);
  subject->satisfied = true;
  loop->wake();
  EXPECT_TRUE(comes_true([&] { return sizes_of(studio->requests()).back() == glm::ivec2(160, 96); }));
}

TEST(RenderLoop, WarmsNothingUpWhileSomebodyWaits) {
  warms_up_only_after(std::make_shared<Greedy>(1));
}

// Shaders take a second to compile: whoever has just seen a picture may want the next one any moment.
TEST(RenderLoop, WarmsNothingUpBetweenPictures) {
  warms_up_only_after(std::make_shared<Unhurried>(1));
}

TEST(RenderLoop, ASizeThatFailsToWarmUpIsPassedOver) {
  const auto studio = std::make_shared<FakeStudio>();
  studio->sizes_to_warm_up = {{160, 96}, {72, 40}};
  const auto loop = fake_loop(studio);
  studio->losing = true;  // the device, with the first of them
  EXPECT_TRUE(comes_true([&] { return sizes_of(studio->requests()).back() == glm::ivec2(72, 40); }));
  EXPECT_EQ(studio->sources, 2);
}

}  // namespace
}  // namespace lightwell::test
