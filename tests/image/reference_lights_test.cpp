// The reference method and what lights a surface: punctual lights, the environment and lights with a size against
// closed forms, judged by its own variance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/image/estimate.h"
#include "tests/image/reference_scenes.h"

namespace lightwell::testing {
namespace {

constexpr double kPi = std::numbers::pi;

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

// Shadow rays pass a pane, and end at a volume; the paths that go on through that find the lamp behind it, so that no
// light of it is lost.
TEST(ReferenceAreaLights, ALampShinesThroughGlass) {
  Material glass;
  glass.metallic_factor = 0.0f;
  glass.roughness_factor = 0.0f;
  glass.transmission_factor = 1.0f;
  const auto light_on_the_floor = [&](bool pane, bool volume, LightStrategy strategy) {
    SceneMaker maker;
    maker.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, maker.material(lambert(glm::vec3(0.5f))));
    maker.quad({-0.25f, 1, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f},
               maker.material(lambert(glm::vec3(0.0f), glm::vec3(8.0f))));
    glass.thickness_factor = volume ? 1.0f : 0.0f;
    const int material = maker.material(glass);
    if (pane) maker.quad({-2, 0.5f, -2}, {4, 0, 0}, {0, 0, 4}, material);     // faces down
    if (volume) maker.quad({-2, 0.51f, 2}, {4, 0, 0}, {0, 0, -4}, material);  // its upper side
    // With one bounce nothing that the floor sends up comes back by a reflection; to pass a pane is none, a volume's
    // are.
    Settings settings = reference_settings(volume ? 8 : 1);
    settings.light_strategy = strategy;
    return estimate_mean(maker.take(), look_at({0, 0.4f, 0.3f}, {0, 0, 0}, 0.002f), settings, {32, 32}, 16);
  };
  const double free = light_on_the_floor(false, false, LightStrategy::kBoth).mean;
  const double reflected = 0.04;
  expect_within(light_on_the_floor(true, false, LightStrategy::kLights), (1.0 - reflected) * free, 0.001, 0.02);
  for (const LightStrategy strategy : {LightStrategy::kBoth, LightStrategy::kRays}) {
    // Near normal incidence.
    expect_within(light_on_the_floor(true, false, strategy), (1.0 - reflected) * free, 0.001, 0.02);
    // The slab brings the lamp nearer by its thickness times 1 - 1 / ior.
    const double nearer = 0.01 * (1.0 - 1.0 / 1.5);
    expect_within(light_on_the_floor(true, true, strategy),
                  (1.0 - reflected) / (1.0 + reflected) * free * std::pow(1.0 - nearer, -2.0), 0.008, 0.02);
  }
}

TEST(ReferenceAreaLights, LightsOfNoSizeOrPowerLightNothing) {
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
