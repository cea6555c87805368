// Photon guides: they change how noisy a picture is, and nothing else.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/passes/photon_targets.h"
#include "tests/image/estimate.h"
#include "tests/image/reference_scenes.h"

namespace lightwell::testing {
namespace {

Material gold() {
  Material material;
  material.base_color_factor = {1.0f, 0.77f, 0.34f, 1.0f};
  material.roughness_factor = 0.1f;
  return material;
}

/// A sphere in a closed room with a small lamp.
Scene room_with_sphere(const Material& of_sphere) {
  SceneMaker maker;
  maker.room({-1, 0, -1}, {1, 2, 1}, maker.material(lambert(glm::vec3(0.7f))));
  maker.quad({-0.15f, 1.999f, -0.15f}, {0.3f, 0, 0}, {0, 0, 0.3f}, maker.material(lambert({}, glm::vec3(20.0f))));
  maker.sphere({0.1f, 0.5f, -0.2f}, 0.35f, 48, false, maker.material(of_sphere));
  return maker.take();
}

// Beside the sphere: lamps in mirrors have edges, whose noise is no matter of guides.
PlacedCamera down_to_the_floor() {
  return look_at({-0.5f, 1.2f, 0.6f}, {-0.45f, 0, 0.45f}, 0.7f);
}

Settings guided_settings(bool guided) {
  Settings settings = reference_settings(8);
  settings.photon_guides = guided;
  return settings;
}

/// Mean squared difference of two pictures with different seeds.
double noise(const Scene& scene, const PlacedCamera& camera, Settings settings) {
  const Pixels one = render(scene, camera, settings, {48, 48}, 16);
  settings.seed = 1;
  const Pixels other = render(scene, camera, settings, {48, 48}, 16);
  double sum = 0.0;
  for (std::size_t i = 0; i < one.rgb.size(); ++i)
    sum += std::pow(static_cast<double>(one.rgb[i]) - static_cast<double>(other.rgb[i]), 2);
  return sum / static_cast<double>(one.rgb.size());
}

void expect_the_same_light(const Scene& scene, const PlacedCamera& camera) {
  const Estimate guided = estimate_mean(scene, camera, guided_settings(true), {32, 32}, 32, 12);
  const Estimate plain = estimate_mean(scene, camera, guided_settings(false), {32, 32}, 32, 12);
  const double sigma = std::hypot(guided.standard_error, plain.standard_error);
  EXPECT_NEAR(guided.mean, plain.mean, 4.0 * sigma);
  EXPECT_LT(sigma, 0.01 * plain.mean);
}

TEST(ReferenceGuides, AMirrorThrowsTheSameLightWithLessNoise) {
  const Scene scene = room_with_sphere(gold());
  expect_the_same_light(scene, down_to_the_floor());
  EXPECT_LT(noise(scene, down_to_the_floor(), guided_settings(true)),
            0.4 * noise(scene, down_to_the_floor(), guided_settings(false)));
}

TEST(ReferenceGuides, TheSunInAMirrorIsFoundToo) {
  SceneMaker maker;
  maker.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, maker.material(lambert(glm::vec3(0.7f))));
  maker.sphere({0, 0.5f, -0.2f}, 0.35f, 48, false, maker.material(gold()));
  maker.directional({0.3f, -1, -0.2f}, 10.0f);
  expect_the_same_light(maker.take(), down_to_the_floor());
}

TEST(ReferenceGuides, TheSameRequestGivesTheSameBytes) {
  const Scene scene = room_with_sphere(gold());
  const Pixels once = render(scene, down_to_the_floor(), guided_settings(true), {32, 32}, 20);
  const Pixels again = render(scene, down_to_the_floor(), guided_settings(true), {32, 32}, 20);
  EXPECT_EQ(once.rgb, again.rgb);
}

TEST(ReferenceGuides, ASceneWithoutMirrorsIsLeftAlone) {
  const Scene scene = room_with_sphere(lambert(glm::vec3(0.5f)));
  EXPECT_EQ(render(scene, down_to_the_floor(), guided_settings(true)).rgb,
            render(scene, down_to_the_floor(), guided_settings(false)).rgb);
}

TEST(PhotonTargets, StandForTheAreasOfMirrors) {
  SceneMaker maker;
  maker.quad({0, 0, 0}, {3, 0, 0}, {0, 2, 0}, maker.material(gold()));        // 6 m2
  maker.quad({0, 0, 1}, {0.5f, 0, 0}, {0, 0.5f, 0}, maker.material(gold()));  // 0.25 m2
  maker.quad({0, 0, 2}, {5, 0, 0}, {0, 5, 0}, maker.material(lambert(glm::vec3(0.5f))));
  const Scene scene = maker.take();
  const std::vector<PhotonTarget> targets = photon_targets(scene, pose_at(scene, 0.0), 1000, 7);
  ASSERT_EQ(targets.size(), 1000u);
  double area_m2 = 0.0;
  for (const PhotonTarget& target : targets) {
    area_m2 += static_cast<double>(target.area_m2);
    EXPECT_NEAR(target.normal_ws.z, 1.0f, 1e-6f);
    EXPECT_TRUE(target.position_ws.z == 0.0f || target.position_ws.z == 1.0f);
  }
  EXPECT_NEAR(area_m2, 6.25, 1e-3);
  EXPECT_TRUE(photon_targets(scene, pose_at(scene, 0.0), 0, 7).empty());
}

TEST(PhotonTargets, AreOnWhatThrowsImagesOnOthers) {
  EXPECT_TRUE(throws_caustics(gold()));
  EXPECT_FALSE(throws_caustics(lambert(glm::vec3(1.0f))));
  EXPECT_FALSE(throws_caustics(Material{}));  // glTF's default: a rough metal
  Material textured;
  textured.metallic_roughness_texture.texture = 0;
  EXPECT_TRUE(throws_caustics(textured));
}

}  // namespace
}  // namespace lightwell::testing
