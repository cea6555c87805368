// How many triangles rays are tested against, counted at the seam: by brute force the product of both, as in the
// thesis; with hierarchies far less.
#include <gtest/gtest.h>

#include <span>

#include "renderer/renderer.h"
#include "renderer/scene/builtin.h"
#include "tests/gl/tracer_fixture.h"

namespace lightwell::test {
namespace {

std::uint32_t word_of(const gl::Buffer& buffer) {
  gl::wait_for_device();
  std::uint32_t word = 0;
  buffer.download(std::as_writable_bytes(std::span(&word, 1)));
  return word;
}

class TriangleTests : public testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = gl::Context::create(); }
  static void TearDownTestSuite() { context_.reset(); }

  /// Tests of closest_hit and of any_hit for `rays` through a shell of 2 * side * side triangles that they never leave.
  struct Counted {
    std::uint32_t closest, any;
  };
  static Counted count(bool brute_force, std::uint32_t side, std::uint32_t ray_count) {
    TraceWorld world;
    world.add(bumpy_shell(side));
    gl::Buffer tests("triangle tests", sizeof(std::uint32_t));
    const std::unique_ptr<Tracer> tracer = make_counting_tracer(brute_force, tests);
    tracer->update(world.scene());
    std::vector<Ray> rays = random_rays(world, ray_count, 7);
    for (Ray& ray : rays) ray.origin_ws *= 0.1f;
    gl::Buffer in("rays", ray_count * sizeof(Ray)), hits("hits", ray_count * sizeof(Hit));
    gl::Buffer visible("visible", (ray_count + 31) / 32 * sizeof(std::uint32_t));
    in.upload(std::span<const Ray>(rays));
    tests.clear();
    tracer->closest_hit(in, ray_count, hits);
    const std::uint32_t closest = word_of(tests);
    tests.clear();
    tracer->any_hit(in, ray_count, visible);
    return {closest, word_of(tests)};
  }

  static inline std::unique_ptr<gl::Context> context_;
};

TEST_F(TriangleTests, ByBruteForceAreRaysTimesTriangles) {
  for (const std::uint32_t side : {8u, 16u, 32u})
    for (const std::uint32_t rays : {100u, 200u, 400u}) {
      const Counted counted = count(true, side, rays);
      EXPECT_EQ(counted.closest, rays * 2 * side * side) << side << " " << rays;
      EXPECT_LT(counted.any, counted.closest);  // the first hit ends the search
    }
}

TEST_F(TriangleTests, WithHierarchiesHardlyGrow) {
  const std::uint32_t few = count(false, 16, 400).closest, many = count(false, 64, 400).closest;
  EXPECT_LT(many, 3 * few);  // of sixteen times the triangles
  EXPECT_LT(50 * many, 400u * 2 * 64 * 64);
}

TEST_F(TriangleTests, OfAFrameAreLinearInItsSamples) {
  gl::Buffer tests;
  RendererOptions options;
  options.tracer = "embree";  // the native one, whatever that is
  options.compile_ahead = false;
  options.make_native_tracer = [&] {
    if (!tests) tests = gl::Buffer("triangle tests", sizeof(std::uint32_t));
    return make_counting_tracer(true, tests);
  };
  Renderer renderer(options);
  const Result<Scene> scene = builtin_scene("cornell");
  ASSERT_TRUE(scene.ok());
  FrameRequest request;
  request.camera = frame_camera(pose_at(*scene, 0.0), 1.0f);
  request.size_px = {16, 16};
  request.settings.indirect_size = 16;
  const auto view = renderer.make_view();
  std::vector<double> per_ray;
  for (const int samples : {8, 16, 32}) {
    request.settings.samples = samples;
    tests.clear();
    const Result<Frame> frame = renderer.render(*scene, request, *view);
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(frame->rays, 256u * static_cast<unsigned>(samples));
    per_ray.push_back(static_cast<double>(word_of(tests)) / static_cast<double>(frame->rays * frame->triangles));
  }
  // The rays of pixels that see a surface try every triangle, those of the background none.
  EXPECT_GT(per_ray[0], 0.5);
  EXPECT_LE(per_ray[0], 1.0);
  for (const double share : per_ray) EXPECT_NEAR(share, per_ray[0], 0.005 * per_ray[0]);
}

}  // namespace
}  // namespace lightwell::test
