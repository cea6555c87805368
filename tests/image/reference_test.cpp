// The reference method against closed forms, judged by its own variance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/image/estimate.h"

namespace lightwell::testing {
namespace {

constexpr double kPi = std::numbers::pi;

Settings reference_settings(int bounces) {
  Settings settings;
  settings.method = Method::kReference;
  settings.bounces = bounces;
  return settings;
}

Scene with_white_sky(SceneMaker maker) {
  Scene scene = maker.take();
  scene.environment.zenith_radiance = scene.environment.horizon_radiance = scene.environment.ground_radiance =
      glm::vec3(1.0f);
  return scene;
}

TEST(ReferenceLights, LambertPlaneUnderOneLuxHasRadianceAlbedoOverPi) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
  maker.directional({0, -1, 0}, 1.0f);
  const Scene scene = maker.take();
  for (const int bounces : {0, 1, kUnlimitedBounces}) {
    const Pixels pixels = render(scene, look_at({0, 3, 0.1f}, {0, 0, 0}), reference_settings(bounces));
    EXPECT_NEAR(pixels.center().g, 0.5 / kPi, 1e-5);
  }
}

TEST(ReferenceLights, PointLightFallsWithTheSquareOfDistance) {
  for (const float distance : {0.5f, 1.0f, 3.0f}) {
    SceneMaker maker;
    maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
    maker.point({0, distance, 0}, 10.0f);
    const Pixels pixels = render(maker.take(), look_at({0, 3, 0.1f}, {0, 0, 0}, 0.005f), reference_settings(0));
    const double expected = 0.5 / kPi * 10.0 / (static_cast<double>(distance) * static_cast<double>(distance));
    EXPECT_NEAR(pixels.center().g, expected, 2e-3 * expected);
  }
}

TEST(ReferenceLights, ASpotShinesInItsConeAndShadowsAreBlack) {
  SceneMaker maker;
  const int grey = maker.material(lambert(glm::vec3(0.5f)));
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, grey);
  maker.quad({-0.1f, 1, -0.1f}, {0, 0, 0.2f}, {0.2f, 0, 0}, grey);
  maker.spot({0, 2, 0}, {0, -1, 0}, 8.0f, 0.5f);
  const Pixels pixels = render(maker.take(), look_at({0, 0.9f, 1}, {0, 0, 0}, 1.0f), reference_settings(0), {33, 33});
  EXPECT_EQ(pixels.center().g, 0.0f);
  EXPECT_GT(pixels.at(16, 24).g, 0.1f);
}

TEST(ReferenceLights, ManyLightsAddUp) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
  maker.point({0, 1, 0}, 1.0f);
  maker.point({0, 2, 0}, 12.0f);
  maker.directional({0, -1, 0}, 3.0f);
  maker.directional({0, -1, 0}, 0.0f);  // without energy
  expect_within(estimate_mean(maker.take(), look_at({0, 3, 0.1f}, {0, 0, 0}, 0.005f), reference_settings(0)),
                0.5 / kPi * (1.0 + 3.0 + 3.0), 1e-3);
}

TEST(ReferenceEnvironment, AConvexLambertBodyUnderAWhiteSkyHasItsAlbedo) {
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 1.0f, 16, false, maker.material(lambert(glm::vec3(0.6f))));
  const Scene scene = with_white_sky(std::move(maker));
  const PlacedCamera camera = look_at({0, 0, 4}, {0, 0, 0}, 0.2f);
  for (const LightStrategy strategy : {LightStrategy::kBoth, LightStrategy::kLights, LightStrategy::kRays}) {
    Settings settings = reference_settings(kUnlimitedBounces);
    settings.light_strategy = strategy;
    expect_within(estimate_mean(scene, camera, settings), 0.6);
  }
}

// A sky whose light is all in one small patch: without samples of its texels it would hardly be found.
TEST(ReferenceEnvironment, AnImageIsSampledWhereItIsBright) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
  Scene scene = maker.take();
  auto image = std::make_shared<ImageHdr>();
  image->size_px = {64, 32};
  image->rgb.assign(64 * 32 * 3, 0.0f);
  const int row = 6, column = 20;
  for (std::size_t channel = 0; channel < 3; ++channel) image->rgb[(row * 64 + column) * 3 + channel] = 1000.0f;
  scene.environment.image = image;
  scene.environment.rotation = 0.7f;
  // The bilinear tent over the texel, times the cosine with the plane's normal, by a fine sum.
  double irradiance = 0.0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double x = 2.0 * (i + 0.5) / kSteps - 1.0, y = 2.0 * (j + 0.5) / kSteps - 1.0;
      const double theta = kPi * (row + 0.5 + y) / 32.0;
      irradiance += 1000.0 * (1.0 - std::abs(x)) * (1.0 - std::abs(y)) * std::cos(theta) * std::sin(theta) *
                    (2.0 / kSteps * kPi / 32.0) * (2.0 / kSteps * 2.0 * kPi / 64.0);
    }
  for (const LightStrategy strategy : {LightStrategy::kBoth, LightStrategy::kLights}) {
    Settings settings = reference_settings(1);
    settings.light_strategy = strategy;
    expect_within(estimate_mean(scene, look_at({0, 3, 0.1f}, {0, 0, 0}, 0.2f), settings), 0.5 / kPi * irradiance, 1e-3);
  }
}

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

/// What a parallel camera sees of a unit square at y = 0, lit by a square that emits 1 nit, over its albedo.
Estimate form_factor(glm::vec3 corner, glm::vec3 edge_u, glm::vec3 edge_v) {
  SceneMaker maker;
  maker.quad({0, 0, 1}, {1, 0, 0}, {0, 0, -1}, maker.material(lambert(glm::vec3(1.0f))));
  maker.quad(corner, edge_u, edge_v, maker.material(lambert(glm::vec3(0.0f), glm::vec3(1.0f))));
  return estimate_mean(maker.take(), look_parallel({0.5f, 0.5f, 0.5f}, {0.5f, 0, 0.5f}, 1.0f), reference_settings(1),
                       {16, 16}, 64);
}

TEST(ReferenceAreaLights, UnitSquaresHaveTheirFormFactors) {
  expect_within(form_factor({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), 0.199825, 0.0, 0.002);
  expect_within(form_factor({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.200044, 0.0, 0.002);
}

TEST(ReferenceAreaLights, ADiskLightOnItsAxis) {
  const double radius = 0.7, height = 1.3, radiance = 5.0;
  SceneMaker maker;
  maker.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, maker.material(lambert(glm::vec3(0.5f))));
  maker.disk({0, 1.3f, 0}, {0, -1, 0}, 0.7f, 256, maker.material(lambert(glm::vec3(0.0f), glm::vec3(5.0f))));
  const double irradiance = kPi * radiance * radius * radius / (radius * radius + height * height);
  expect_within(estimate_mean(maker.take(), look_at({0, 1.0f, 0.5f}, {0, 0, 0}, 0.002f), reference_settings(1)),
                0.5 / kPi * irradiance, 3e-4);  // the polygon has 0.01 % less area; the patch is not a point
}

// Lambert's formula (1760): E = L / 2 * the sum over edges of the angle they subtend times the edge normal's part along
// the surface normal.
double polygon_irradiance(const std::vector<glm::dvec3>& corners, double radiance) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i]), b = glm::normalize(corners[(i + 1) % corners.size()]);
    const glm::dvec3 axis = glm::cross(a, b);
    sum += std::acos(glm::dot(a, b)) * axis.y / glm::length(axis);
  }
  return std::abs(0.5 * radiance * sum);
}

TEST(ReferenceAreaLights, ARectangleLightHasThePolygonsIrradiance) {
  const glm::vec3 corner(0.5f, 0.2f, -1.0f), edge_u(0.3f, 0.8f, 0.2f), edge_v(-0.4f, 0.3f, 1.1f);
  SceneMaker maker;
  maker.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, maker.material(lambert(glm::vec3(0.5f))));
  maker.quad(corner, edge_u, edge_v, maker.material(lambert(glm::vec3(0.0f), glm::vec3(5.0f))));
  const glm::dvec3 c(corner), u(edge_u), v(edge_v);
  const double irradiance = polygon_irradiance({c, c + u, c + u + v, c + v}, 5.0);
  const Scene scene = maker.take();
  for (const LightStrategy strategy : {LightStrategy::kBoth, LightStrategy::kLights, LightStrategy::kRays}) {
    Settings settings = reference_settings(1);
    settings.light_strategy = strategy;
    expect_within(estimate_mean(scene, look_at({-0.2f, 1.0f, 0.3f}, {0, 0, 0}, 0.002f), settings),
                  0.5 / kPi * irradiance, 2e-4, strategy == LightStrategy::kRays ? 0.04 : 0.01);
  }
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

/// A room with a lamp, a rough metal, a plastic and a mirror-like block, under a sky through its open front.
Scene varied_room(float scale) {
  SceneMaker maker;
  const auto surface = [&](glm::vec3 color, float metallic, float roughness) {
    Material material;
    material.base_color_factor = glm::vec4(color, 1.0f);
    material.metallic_factor = metallic;
    material.roughness_factor = roughness;
    return maker.material(material);
  };
  const int wall = maker.material(lambert(glm::vec3(0.7f)));
  const auto quad = [&](glm::vec3 corner, glm::vec3 u, glm::vec3 v, int material) {
    maker.quad(scale * corner, scale * u, scale * v, material);
  };
  quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, surface({0.8f, 0.6f, 0.3f}, 1.0f, 0.3f));  // floor
  quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, wall);
  quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, surface({0.5f, 0.5f, 0.6f}, 0.0f, 0.4f));
  quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, wall);
  quad({1, -1, 1}, {0, 2, 0}, {0, 0, -2}, wall);
  quad({-0.4f, 0.8f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, maker.material(lambert(glm::vec3(0), glm::vec3(6.0f))));
  maker.spot(scale * glm::vec3(0.7f, 0.7f, 0.7f), {-0.6f, -0.7f, -0.5f}, 2.0f * scale * scale, 0.6f);
  Scene scene = maker.take();
  scene.environment.horizon_radiance = {0.6f, 0.7f, 1.0f};
  scene.environment.zenith_radiance = {0.3f, 0.4f, 1.0f};
  return scene;
}

TEST(ReferenceStrategies, EachAloneHasTheSameMean) {
  const Scene scene = varied_room(1.0f);
  const PlacedCamera camera = look_at({0, 0, 3.0f}, {0, 0, 0}, 0.6f);
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
    PlacedCamera camera = look_at(glm::vec3(0, 0, 3.0f) * scale, glm::vec3(0.0f), 0.6f);
    camera.camera.znear *= scale;
    return estimate_mean(varied_room(scale), camera, reference_settings(4), {24, 24}, 16);
  };
  const Estimate one = at_scale(1.0f), ten = at_scale(10.0f);
  expect_within({ten.mean, std::hypot(ten.standard_error, one.standard_error)}, one.mean);
}

TEST(ReferenceFrames, TheSameSeedGivesTheSameBytes) {
  const Scene scene = varied_room(1.0f);
  const PlacedCamera camera = look_at({0, 0, 3.0f}, {0, 0, 0}, 0.6f);
  Settings settings = reference_settings(6);
  const auto first = render(scene, camera, settings, {48, 32}, 3).rgb;
  EXPECT_EQ(render(scene, camera, settings, {48, 32}, 3).rgb, first);
  settings.seed = 1;
  EXPECT_NE(render(scene, camera, settings, {48, 32}, 3).rgb, first);
}

TEST(ReferenceFrames, ThousandsOfSamplesKeepTheirMean) {
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 1.0f, 16, false, maker.material(lambert(glm::vec3(0.6f))));
  const Scene scene = with_white_sky(std::move(maker));
  Settings settings = reference_settings(1);
  settings.light_strategy = LightStrategy::kRays;  // every sample is the albedo
  const Pixels pixels = render(scene, look_at({0, 0, 4}, {0, 0, 0}, 0.2f), settings, {4, 4}, 5000);
  for (const float value : pixels.rgb) EXPECT_NEAR(value, 0.6f, 2e-6f);
}

TEST(ReferenceFrames, TheErrorFallsAtLeastAsOneOverN) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f))));
  maker.quad({-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f},
             maker.material(lambert(glm::vec3(0.0f), glm::vec3(6.0f))));
  maker.point({0.2f, -0.3f, 0.1f}, 0.3f);
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 0, 0.9f}, {0, 0, -1}, 1.2f);
  Settings settings = reference_settings(4);
  const glm::ivec2 size_px(24, 24);
  settings.seed = 77;
  const Pixels truth = render(scene, camera, settings, size_px, 2048);
  settings.seed = 0;
  const double scale = 1.0 / static_cast<double>(truth.mean().g);
  const auto rel_mse = [&](int spp) {
    const Pixels pixels = render(scene, camera, settings, size_px, spp);
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
      const double b = scale * static_cast<double>(truth.rgb[i]);
      sum += std::pow(scale * static_cast<double>(pixels.rgb[i]) - b, 2.0) / (b * b + 0.01);
    }
    return sum / static_cast<double>(truth.rgb.size());
  };
  const double slope = std::log(rel_mse(128) / rel_mse(16)) / std::log(128.0 / 16.0);
  EXPECT_LT(slope, -0.9);
}

// render() itself fails on a value that is not finite or negative.
TEST(ReferenceFrames, ExtremesStayFinite) {
  const PlacedCamera camera = look_at({0, 0, 0.9f}, {0, 0, -1}, 1.2f);
  const auto in_room = [&](const Material& material, PlacedCamera from, int bounces = 4) {
    SceneMaker maker;
    maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(material));
    maker.point({0.2f, 0.3f, 0.1f}, 3.0f);
    return render(maker.take(), from, reference_settings(bounces), {16, 16}, 4);
  };
  in_room(lambert(glm::vec3(0.9f), glm::vec3(1e30f)), camera);
  in_room(lambert(glm::vec3(1.0f), glm::vec3(1.0f)), camera, kUnlimitedBounces);
  for (const float roughness : {0.0f, 1.0f, -3.0f, 7.0f})
    for (const float metallic : {0.0f, 1.0f, 5.0f}) {
      Material material;
      material.roughness_factor = roughness;
      material.metallic_factor = metallic;
      in_room(material, camera);
    }
  in_room(lambert(glm::vec3(0.5f)), look_at({5, 0, 0}, {6, 0, 0}));  // outside, looking away
  in_room(lambert(glm::vec3(0.5f)), look_at({1, 1, 1}, {0, 0, 0}));  // in a corner
  PlacedCamera flat = camera;
  flat.world_from_view[0] = glm::vec4(0.0f);
  in_room(lambert(glm::vec3(0.5f)), flat);
}

TEST(ReferenceFrames, LightsOfNoSizeOrPowerLightNothing) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(lambert(glm::vec3(0.5f))));
  const int emitter = maker.material(lambert(glm::vec3(0.0f), glm::vec3(9.0f)));
  maker.triangles({{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 0, 1, 3}, emitter);
  maker.point({0, 1, 0}, 0.0f);
  const Pixels pixels =
      render(maker.take(), look_at({0, 3, 0.1f}, {0, 0, 0}, 0.2f), reference_settings(3), {16, 16}, 4);
  EXPECT_EQ(pixels.mean(), glm::vec3(0.0f));
}

}  // namespace
}  // namespace lightwell::testing
