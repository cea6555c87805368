// Light transport in the lanes of the processor: the same numbers whatever the processor, and the right ones.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "renderer/lanes/choose.h"

namespace lightwell::lanes {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr float kPi = 3.14159265f;

std::uint32_t unorm2(float low, float high) {
  return static_cast<std::uint32_t>(std::lround(low * 65535.0f)) |
         static_cast<std::uint32_t>(std::lround(high * 65535.0f)) << 16;
}
// The octahedral map of a direction with z >= 0.
std::uint32_t octahedral(float x, float y, float z) {
  const float scale = 32767.0f / (std::abs(x) + std::abs(y) + z);
  return (static_cast<std::uint32_t>(std::lround(x * scale)) & 0xffffu) |
         static_cast<std::uint32_t>(std::lround(y * scale)) << 16;
}

// Pixels on the plane z = 0, seen from above, white and without a specular lobe.
struct Floor {
  std::unique_ptr<PatchPixels> pixels = std::make_unique<PatchPixels>();
  PackedReceivers packed;

  explicit Floor(const PatchKernels& kernels) {
    std::memset(&packed, 0, sizeof packed);
    std::memset(pixels.get(), 0, sizeof *pixels);
    for (std::uint32_t i = 0; i < kChunkPixels; ++i) {
      packed.normal[i] = packed.geometric_normal[i] = packed.to_camera[i] = octahedral(0.0f, 0.0f, 1.0f);
      packed.base_color_rg[i] = unorm2(1.0f, 0.5f);
      packed.base_color_b_metallic[i] = unorm2(0.25f, 0.0f);
      packed.material_roughness[i] = 0xffff0000u;
      pixels->above[0][i] = static_cast<float>(i);
    }
    kernels.unpack(packed, *pixels);
  }
};

LightEnvironment dark() {
  LightEnvironment environment;
  std::memset(&environment, 0, sizeof environment);
  environment.shadow_side_px = 2;
  environment.shadow_least_variance = 1e-7f;
  environment.shadow_cube_scale = 1.0f;
  return environment;
}

const PatchDirection kUp{{0.0f, 0.0f, 1.0f}, 1.0f / kPi};

// In the plane z = height, over 4 <= x <= 12, y = -4 to 4.
AffineTriangle triangle_above(float height) {
  return {{4.0f, -4.0f, height}, {0.125f, 0.0f, 0.0f}, {0.0f, 0.125f, 0.0f}, {0.0f, 0.0f, -1.0f}};
}

class LanesTest : public ::testing::TestWithParam<const PatchKernels*> {};

TEST_P(LanesTest, RaysMeetTheNearestOfTheirCandidates) {
  const PatchKernels& kernels = *GetParam();
  Floor floor(kernels);
  PatchPixels& pixels = *floor.pixels;
  const PixelRun run{1, 60};
  kernels.start_rays(pixels, run, kUp);
  kernels.meet(pixels, run, triangle_above(3.0f), 0);
  kernels.meet(pixels, run, triangle_above(2.0f), 1);
  kernels.meet(pixels, run, triangle_above(-1.0f), 2);  // behind the origins
  for (std::uint32_t i = run.begin; i < run.end; ++i) {
    const float x = static_cast<float>(i);
    const bool inside = x >= 4.0f && x <= 8.0f;  // v is a half here, so u goes up to a half
    EXPECT_EQ(pixels.t[i], inside ? 2.0f : kNothing) << i;
    if (!inside) continue;
    EXPECT_EQ(pixels.candidate[i], 1u);
    EXPECT_NEAR(pixels.u[i], (x - 4.0f) * 0.125f, 1e-6f);
    EXPECT_NEAR(pixels.v[i], 0.5f, 1e-6f);
  }
}

TEST_P(LanesTest, RaysToTheInnerSideStartBelow) {
  const PatchKernels& kernels = *GetParam();
  Floor floor(kernels);
  floor.pixels->down[2][5] = -1.0f;
  kernels.start_rays(*floor.pixels, {0, kChunkPixels}, {{0.0f, 0.0f, -1.0f}, 1.0f});
  EXPECT_EQ(floor.pixels->from[2][5], -1.0f);
  EXPECT_EQ(floor.pixels->from[2][6], 0.0f);
  kernels.start_rays(*floor.pixels, {0, kChunkPixels}, kUp);
  EXPECT_EQ(floor.pixels->from[2][5], 0.0f);
}

// A Lambert floor under an even sky: each direction, drawn by the cosine, brings albedo times radiance.
TEST_P(LanesTest, AFloorGathersTheSky) {
  const PatchKernels& kernels = *GetParam();
  Floor floor(kernels);
  LightEnvironment sky = dark();
  for (float* radiance : {sky.zenith_radiance, sky.horizon_radiance, sky.ground_radiance})
    for (int channel = 0; channel < 3; ++channel) radiance[channel] = 2.0f;
  for (const float x : {0.0f, 0.6f, -0.8f}) {
    const float z = std::sqrt(1.0f - x * x);
    const PatchDirection direction{{x, 0.0f, z}, z / kPi};
    kernels.start_rays(*floor.pixels, {0, 63}, direction);
    kernels.gather(*floor.pixels, {0, 63}, direction, nullptr, 0, sky);
  }
  for (std::uint32_t i = 0; i < kChunkPixels; ++i) {
    const float share = i < 63 ? 1.0f : 0.0f;  // the last is not in the run
    EXPECT_NEAR(floor.pixels->sum[0][i], 6.0f * share, 1e-4f) << i;
    EXPECT_NEAR(floor.pixels->sum[1][i], 3.0f * share, 1e-4f) << i;
    EXPECT_NEAR(floor.pixels->sum[2][i], 1.5f * share, 1e-4f) << i;
    EXPECT_EQ(floor.pixels->hit_count[i], 0.0f);
  }
}

// A Lambert ceiling lit by a point light at distance d under it sends down albedo / pi * I / d^2.
TEST_P(LanesTest, HitsReflectAPointLight) {
  const PatchKernels& kernels = *GetParam();
  Floor floor(kernels);
  PatchPixels& pixels = *floor.pixels;
  PackedLight light;
  std::memset(&light, 0, sizeof light);
  light.position_ws[0] = 6.0f;
  light.kind = 1;
  light.intensity[0] = light.intensity[1] = light.intensity[2] = 8.0f;
  light.shadow_far_m = 100.0f;
  light.first_shadow_layer = 0;
  LightEnvironment environment = dark();
  environment.lights = &light;
  environment.light_count = 1;
  std::vector<float> moments(2 * 2 * 2 * 6 + 4, 1.0f);  // nothing before the far end: all is lit
  environment.shadow_moments = moments.data();
  HitSurface ceiling;
  std::memset(&ceiling, 0, sizeof ceiling);
  for (auto& normal : ceiling.normals) normal[2] = 3.0f;  // of any length
  ceiling.geometric_normal[2] = 1.0f;
  for (float& channel : ceiling.base_color) channel = 0.5f;
  ceiling.emission[1] = 1.0f;
  ceiling.roughness = 1.0f;
  ceiling.lit = 1.0f;
  const Candidate candidate{&ceiling, -1.0f};  // seen from its back
  const PixelRun run{0, kChunkPixels};
  kernels.start_rays(pixels, run, kUp);
  kernels.meet(pixels, run, triangle_above(2.0f), 0);
  kernels.gather(pixels, run, kUp, &candidate, 1, environment);
  for (std::uint32_t i = 0; i < kChunkPixels; ++i) {
    const bool hit = i >= 4 && i <= 8;
    const float x = static_cast<float>(i) - 6.0f, distance2 = x * x + 4.0f;
    const float reflected = 0.5f / kPi * 8.0f / distance2 * 2.0f / std::sqrt(distance2);
    EXPECT_NEAR(pixels.sum[0][i], hit ? reflected : 0.0f, 3e-5f) << i;
    EXPECT_NEAR(pixels.sum[1][i], hit ? 0.5f * (reflected + 1.0f) : 0.0f, 3e-5f) << i;
    EXPECT_EQ(pixels.distance[i], hit ? 2.0f : 0.0f);
  }

  // The same hits in shadow give their own light alone; unlit ones give none.
  for (std::size_t i = 0; i < moments.size(); ++i) moments[i] = i % 2 == 0 ? 1e-3f : 1e-6f;
  Floor shaded(kernels);
  kernels.start_rays(*shaded.pixels, run, kUp);
  kernels.meet(*shaded.pixels, run, triangle_above(2.0f), 0);
  kernels.gather(*shaded.pixels, run, kUp, &candidate, 1, environment);
  EXPECT_NEAR(shaded.pixels->sum[1][6], 0.5f, 1e-3f);
  ceiling.lit = 0.0f;
  Floor unlit(kernels);
  kernels.start_rays(*unlit.pixels, run, kUp);
  kernels.meet(*unlit.pixels, run, triangle_above(2.0f), 0);
  kernels.gather(*unlit.pixels, run, kUp, &candidate, 1, environment);
  EXPECT_EQ(unlit.pixels->sum[1][6], 0.0f);
}

// Everything at random: rays one by one are the run, and all processors agree.
TEST_P(LanesTest, ScatteredRaysAndAllProcessorsAgree) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(0.0f, 1.0f);
  PackedReceivers packed;
  std::memset(&packed, 0, sizeof packed);
  PatchPixels start;
  std::memset(&start, 0, sizeof start);
  for (std::uint32_t i = 0; i < kChunkPixels; ++i) {
    const auto around_up = [&] { return octahedral(any(random) - 0.5f, any(random) - 0.5f, 1.0f); };
    packed.normal[i] = around_up(), packed.geometric_normal[i] = around_up(), packed.to_camera[i] = around_up();
    packed.base_color_rg[i] = unorm2(any(random), any(random));
    packed.base_color_b_metallic[i] = unorm2(any(random), any(random));
    packed.material_roughness[i] = unorm2(0.0f, any(random));
    packed.dielectric[i] = unorm2(0.04f, any(random));
    for (auto& axis : start.above) axis[i] = any(random) * 8.0f;
  }
  std::vector<float> moments(2 * 64 * 64 * 8 + 4);
  for (float& moment : moments) moment = any(random);
  std::vector<PackedLight> lights(3);
  for (std::uint32_t kind = 0; kind < 3; ++kind) {
    PackedLight& light = lights[kind];
    std::memset(&light, 0, sizeof light);
    light.kind = kind;
    light.position_ws[0] = 3.0f, light.position_ws[1] = 4.0f, light.position_ws[2] = 2.0f;
    light.direction_ws[2] = 1.0f;
    light.intensity[0] = light.intensity[1] = light.intensity[2] = 5.0f;
    light.inverse_range = 0.01f;
    light.spot_scale = 2.0f, light.spot_offset = -1.0f;
    light.shadow_far_m = 20.0f;
    light.first_shadow_layer = kind == 0 ? 0 : kind == 1 ? 1 : 7;
    for (int i = 0; i < 4; ++i) light.shadow_clip_from_world[i][i] = i < 3 ? 0.1f : 1.0f;
  }
  LightEnvironment environment = dark();
  environment.lights = lights.data();
  environment.light_count = 3;
  environment.shadow_moments = moments.data();
  environment.shadow_side_px = 64;
  environment.zenith_radiance[0] = 1.0f, environment.horizon_radiance[1] = 1.0f, environment.ground_radiance[2] = 1.0f;
  HitSurface surface;
  std::memset(&surface, 0, sizeof surface);
  for (auto& normal : surface.normals) normal[0] = any(random) - 0.5f, normal[1] = any(random) - 0.5f, normal[2] = 1.0f;
  surface.geometric_normal[2] = 1.0f;
  surface.base_color[0] = 0.7f, surface.base_color[1] = 0.5f, surface.metallic = 0.4f, surface.roughness = 0.5f;
  surface.f0_dielectric = 0.04f, surface.specular_factor = 1.0f, surface.lit = 1.0f;
  const Candidate candidate{&surface, -1.0f};
  const PatchDirection direction{{0.28f, 0.0f, 0.96f}, 0.3f};
  const AffineTriangle triangle{
      {0.0f, 0.0f, 9.0f}, {0.1f, 0.0f, 0.0f}, {0.0f, 0.1f, 0.0f}, {0.0f, 0.0f, -1.0f / 0.96f}};

  const auto gathered = [&](const PatchKernels& kernels, bool scattered) {
    PatchPixels pixels = start;
    kernels.unpack(packed, pixels);
    const PixelRun run{0, kChunkPixels};
    kernels.start_rays(pixels, run, direction);
    kernels.meet(pixels, run, triangle, 0);
    if (!scattered) {
      kernels.gather(pixels, run, direction, &candidate, 1, environment);
      return pixels;
    }
    const auto rays = std::make_unique<ScatteredRays>();
    std::memset(rays.get(), 0, sizeof *rays);
    constexpr std::uint32_t kRays = kMostLanes - 1;
    for (std::uint32_t lane = 0; lane < kRays; ++lane) {
      const std::uint32_t pixel = kRays - 1 - lane;
      rays->pixel[lane] = pixel;
      for (int axis = 0; axis < 3; ++axis) {
        rays->from[axis][lane] = pixels.from[axis][pixel];
        rays->direction_ws[axis][lane] = direction.direction_ws[axis];
      }
      rays->pdf[lane] = direction.pdf;
      rays->t[lane] = pixels.t[pixel], rays->u[lane] = pixels.u[pixel], rays->v[lane] = pixels.v[pixel];
      rays->side[lane] = candidate.side;
      rays->surfaces[lane] = surface;
    }
    kernels.gather_scattered(pixels, *rays, kRays, environment);
    for (std::uint32_t lane = 0; lane < kRays; ++lane)
      for (int channel = 0; channel < 3; ++channel) pixels.sum[channel][rays->pixel[lane]] = rays->sum[channel][lane];
    return pixels;
  };
  const PatchPixels expected = gathered(*usable_patch_kernels().back(), false);
  const PatchPixels run = gathered(*GetParam(), false), scattered = gathered(*GetParam(), true);
  int hits = 0;
  for (std::uint32_t i = 0; i < kChunkPixels; ++i) {
    hits += expected.t[i] < kNothing ? 1 : 0;
    for (int channel = 0; channel < 3; ++channel) {
      const float sum = expected.sum[channel][i];
      EXPECT_NEAR(run.sum[channel][i], sum, 1e-4f * sum + 1e-5f) << i;
      EXPECT_NEAR(scattered.sum[channel][i], i < kMostLanes - 1 ? sum : 0.0f, 1e-4f * sum + 1e-5f) << i;
    }
    EXPECT_FLOAT_EQ(run.distance[i], expected.distance[i]);
  }
  EXPECT_GT(hits, 8);
  EXPECT_LT(hits, 60);
}

INSTANTIATE_TEST_SUITE_P(Processors, LanesTest, ::testing::ValuesIn(usable_patch_kernels()),
                         [](const ::testing::TestParamInfo<const PatchKernels*>& processor) {
                           std::string name;
                           for (const char* c = processor.param->instructions; *c != 0; ++c)
                             if (*c != '-') name += *c;
                           return name;
                         });

}  // namespace
}  // namespace lightwell::lanes
