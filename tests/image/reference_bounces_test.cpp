// The reference method in closed scenes, whose light is a geometric series; and every strategy to find lights alone,
// which must have the same mean.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/image/estimate.h"
#include "tests/image/reference_scenes.h"

namespace lightwell::testing {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(ReferenceBounces, AClosedEmissiveBoxIsAGeometricSeries) {
  const double emission = 2.0, albedo = 0.6;
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f), glm::vec3(2.0f))));
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 0, 0.9f}, {0, 0, -1}, 1.2f);
  for (const int bounces : {0, 1, 3, 8})
    expect_within(estimate_mean(scene, camera, reference_settings(bounces), {16, 16}, 4),
                  emission * (1.0 - std::pow(albedo, bounces + 1)) / (1.0 - albedo));
  expect_within(estimate_mean(scene, camera, reference_settings(kUnlimitedBounces), {16, 16}, 4),
                emission / (1.0 - albedo));
}

TEST(ReferenceBounces, AnIntegratingSphereWithACentralLight) {
  const double radius = 2.0, candela = 3.0, albedo = 0.7;
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 2.0f, 96, true, maker.material(lambert(glm::vec3(0.7f))));
  maker.point({0, 0, 0}, 3.0f);
  const double irradiance = 4.0 * kPi * candela / (4.0 * kPi * radius * radius);
  expect_within(
      estimate_mean(maker.take(), look_at({0, 0, 0.5f}, {0, 0, -1}, 1.0f), reference_settings(kUnlimitedBounces)),
      albedo * irradiance / (kPi * (1.0 - albedo)), 2e-3);  // faces lie within the sphere
}

TEST(ReferenceBounces, AbsorbedIsEmittedInAClosedScene) {
  const double emission = 4.0;
  SceneMaker maker;
  const glm::vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), low(-1), high(1);
  const double albedos[6] = {0.2, 0.5, 0.8, 0.3, 0.65, 0.4};
  const glm::vec3 faces[6] = {{0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {-1, 0, 0}, {1, 0, 0}};
  const auto grey = [&](int i) {
    return maker.material(lambert(glm::vec3(static_cast<float>(albedos[i])), glm::vec3(i == 1 ? 4.0f : 0.0f)));
  };
  maker.quad(low, z, x, grey(0));
  maker.quad(high, -x, -z, grey(1));
  maker.quad(low, x, y, grey(2));
  maker.quad(high, -y, -x, grey(3));
  maker.quad(low, y, z, grey(4));
  maker.quad(high, -z, -y, grey(5));
  const Scene scene = maker.take();
  double absorbed = 0.0, variance = 0.0;
  for (int i = 0; i < 6; ++i) {
    const Estimate leaving = estimate_mean(scene, look_parallel({0, 0, 0}, faces[i], 2.0f),
                                           reference_settings(kUnlimitedBounces), {16, 16}, 16, 8);
    const double scale = (1.0 - albedos[i]) * kPi / albedos[i];
    absorbed += scale * (leaving.mean - (i == 1 ? emission : 0.0));
    variance += std::pow(scale * leaving.standard_error, 2.0);
  }
  expect_within({absorbed, std::sqrt(variance)}, kPi * emission);
}

TEST(ReferenceStrategies, EachAloneHasTheSameMean) {
  const Scene scene = varied_room();
  const PlacedCamera camera = before_varied_room();
  const auto with = [&](LightStrategy strategy) {
    Settings settings = reference_settings(4);
    settings.light_strategy = strategy;
    return estimate_mean(scene, camera, settings, {24, 24}, 32);
  };
  const Estimate both = with(LightStrategy::kBoth), lights = with(LightStrategy::kLights),
                 rays = with(LightStrategy::kRays);
  for (const Estimate& alone : {lights, rays})
    expect_within({alone.mean, std::hypot(alone.standard_error, both.standard_error)}, both.mean);
  EXPECT_LT(both.standard_error, 1.5 * std::min(lights.standard_error, rays.standard_error));
}

// Scenes without a specular lobe have shaders of their own; a mirror that nobody sees makes the scene one with lobes.
TEST(ReferenceBounces, LambertScenesLookLikeThoseWithLobes) {
  const auto mean = [](bool with_a_mirror) {
    SceneMaker maker;
    maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f))));
    maker.quad({-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f},
               maker.material(lambert(glm::vec3(0.0f), glm::vec3(6.0f))));
    if (with_a_mirror) maker.quad({9, 9, 9}, {1, 0, 0}, {0, 1, 0}, maker.material(Material{}));
    return estimate_mean(maker.take(), look_at({0, 0, 0.9f}, {0, 0, -1}, 1.2f), reference_settings(4));
  };
  const Estimate without = mean(false), with = mean(true);
  EXPECT_NEAR(without.mean, with.mean, 1e-4 * with.mean);  // the same samples
  EXPECT_LT(without.standard_error, 0.01 * with.mean);
}

TEST(ReferenceStrategies, EachAloneSeesTheSameReflectance) {
  for (const float metallic : {0.0f, 1.0f})
    for (const float roughness : {0.3f, 0.7f}) {
      Material material;
      material.base_color_factor = {0.8f, 0.6f, 0.3f, 1.0f};
      material.metallic_factor = metallic;
      material.roughness_factor = roughness;
      SceneMaker maker;
      maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(material));
      const Scene scene = with_white_sky(std::move(maker));
      const auto with = [&](LightStrategy strategy) {
        Settings settings = reference_settings(1);
        settings.light_strategy = strategy;
        return estimate_mean(scene, look_at({0, 3, 3}, {0, 0, 0}, 0.01f), settings, {48, 48}, 4, 8);
      };
      SCOPED_TRACE(::testing::Message() << "metallic " << metallic << ", roughness " << roughness);
      const Estimate both = with(LightStrategy::kBoth);
      for (const LightStrategy strategy : {LightStrategy::kLights, LightStrategy::kRays}) {
        const Estimate alone = with(strategy);
        expect_within({alone.mean, std::hypot(alone.standard_error, both.standard_error)}, both.mean, 0.0, 0.03);
      }
    }
}

// A lamp half of which is black, on a plane with lobes of extensions: the shaders for both.
TEST(ReferenceStrategies, ATexturedLampOnACoatedPlane) {
  SceneMaker maker;
  Material coated = lambert(glm::vec3(0.5f));
  coated.clearcoat_factor = 1.0f;
  coated.clearcoat_roughness = 0.5f;
  coated.sheen_color_factor = glm::vec3(0.3f);
  coated.sheen_roughness = 0.5f;
  maker.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, maker.material(coated));
  Material lamp = lambert(glm::vec3(0.0f), glm::vec3(5.0f));
  lamp.emissive_texture.texture = 0;
  maker.quad({-0.5f, 0.6f, -0.5f}, {1, 0, 0}, {0, 0, 1}, maker.material(lamp), true);
  Scene scene = maker.take();
  auto image = std::make_shared<Image>();
  image->size_px = {2, 1};
  image->rgba = {255, 255, 255, 255, 0, 0, 0, 255};
  scene.images.push_back(image);
  Texture texture;
  texture.image = 0;
  texture.sampler.mag_nearest = true;
  scene.textures.push_back(texture);
  const auto with = [&](LightStrategy strategy) {
    Settings settings = reference_settings(2);
    settings.light_strategy = strategy;
    return estimate_mean(scene, look_at({0, 0.5f, 2}, {0, 0, 0}, 0.2f), settings, {32, 32}, 8);
  };
  const Estimate both = with(LightStrategy::kBoth);
  for (const LightStrategy strategy : {LightStrategy::kLights, LightStrategy::kRays}) {
    const Estimate alone = with(strategy);
    expect_within({alone.mean, std::hypot(alone.standard_error, both.standard_error)}, both.mean, 0.0, 0.03);
  }
}

TEST(ReferenceStrategies, AScaledSceneIsTheSamePicture) {
  const auto at_scale = [](float scale) {
    return estimate_mean(varied_room(scale), before_varied_room(scale), reference_settings(4), {24, 24}, 16);
  };
  const Estimate one = at_scale(1.0f), ten = at_scale(10.0f);
  expect_within({ten.mean, std::hypot(ten.standard_error, one.standard_error)}, one.mean);
}

}  // namespace
}  // namespace lightwell::testing
