// Coverage by alpha, which every tracer must see alike.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/gl/tracer_fixture.h"

namespace lightwell::test {
namespace {

// Leaves: random alpha of 16 x 16 texels on a soup of triangles, wrapped in every way.
TraceWorld covered_world(AlphaMode mode) {
  auto image = std::make_shared<Image>();
  image->size_px = {16, 16};
  std::mt19937 random(11);
  for (int i = 0; i < 16 * 16 * 4; ++i) image->rgba.push_back(static_cast<std::uint8_t>(random() >> 24));
  Coverage coverage;
  coverage.mode = mode;
  coverage.image = image;
  coverage.use.rotation = 0.3f;
  coverage.use.scale = {2.0f, 3.0f};
  coverage.use.offset = {-0.7f, 0.2f};
  TraceWorld world;
  world.name = mode == AlphaMode::kMask ? "masked" : "blended";
  for (std::uint32_t i = 0; i < 3; ++i) {
    coverage.wrap_s = static_cast<Wrap>(i);
    coverage.wrap_t = static_cast<Wrap>(2 - i);
    coverage.factor = mode == AlphaMode::kBlend ? 0.9f : 1.0f;
    world.add(random_triangles(3000, 1.5f, 20 + i), glm::mat4(1.0f), coverage);
  }
  world.add(random_triangles(1000, 1.0f, 24));
  return world;
}

TEST_F(TracerTest, TracersAgreeOnCoverage) {
  if (!tracers_.contains("embree")) GTEST_SKIP() << "built without Embree";
  for (const AlphaMode mode : {AlphaMode::kMask, AlphaMode::kBlend}) {
    const TraceWorld world = covered_world(mode);
    const std::vector<Ray> rays = random_rays(world, 200'000, 31);
    const auto results = trace_all(world, rays);
    expect_agreement(world, rays, results.at("embree").hits, results.at("compute").hits, true);
  }
}

// One square of 2 x 2 texels whose alpha is 0, 100, 150 and 255.
TraceWorld covered_square(const Coverage& coverage) {
  auto image = std::make_shared<Image>();
  image->size_px = {2, 2};
  image->rgba = {9, 9, 9, 0, 9, 9, 9, 100, 9, 9, 9, 150, 9, 9, 9, 255};
  auto square = std::make_shared<Primitive>();
  square->positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
  square->uv0 = {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}};
  square->indices = {0, 1, 2, 0, 2, 3};
  TraceWorld world;
  world.name = "covered square";
  Coverage covered = coverage;
  covered.image = image;
  world.add(square, glm::mat4(1.0f), covered);
  return world;
}

std::vector<Ray> square_rays(std::uint32_t side) {
  std::vector<Ray> rays;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const glm::vec2 p = (glm::vec2(x, y) + 0.5f) / static_cast<float>(side);
      rays.push_back({{p, 1.0f}, 0.0f, {0.0f, 0.0f, -1.0f}, 10.0f});
    }
  return rays;
}

TEST_F(TracerTest, MaskHitsWhereAlphaReachesTheCutoff) {
  Coverage coverage;
  coverage.mode = AlphaMode::kMask;
  coverage.cutoff = 0.5f;
  coverage.factor = 0.9f;  // 150 / 255 * 0.9 = 0.53
  const TraceWorld world = covered_square(coverage);
  for (const auto& [name, result] : trace_all(world, square_rays(8)))
    for (int i = 0; i < 64; ++i) EXPECT_EQ(is_hit(result.hits[static_cast<std::size_t>(i)]), i / 8 >= 4) << name << i;
}

TEST_F(TracerTest, BlendHitsAsOftenAsAlphaSays) {
  Coverage coverage;
  coverage.mode = AlphaMode::kBlend;
  coverage.factor = 0.8f;
  const TraceWorld world = covered_square(coverage);
  constexpr std::uint32_t kSide = 256;
  for (const auto& [name, result] : trace_all(world, square_rays(kSide))) {
    double hits[4] = {};
    for (std::uint32_t i = 0; i < kSide * kSide; ++i)
      hits[(i / kSide) / (kSide / 2) * 2 + (i % kSide) / (kSide / 2)] += is_hit(result.hits[i]);
    const double alphas[4] = {0.0, 100.0 / 255.0, 150.0 / 255.0, 1.0};
    for (int texel = 0; texel < 4; ++texel) {
      const double p = 0.8 * alphas[texel], n = kSide * kSide / 4.0;
      EXPECT_NEAR(hits[texel], n * p, 4.0 * std::sqrt(n * p * (1.0 - p)) + 0.5) << name << " texel " << texel;
    }
  }
}

}  // namespace
}  // namespace lightwell::test
