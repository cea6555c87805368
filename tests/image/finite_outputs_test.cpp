// Every texel of every output of every method is a finite number that is not negative, whatever a scene, a camera or a
// setting asks for. `render` of test_scenes.h fails on a value that is not.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/image/reference_scenes.h"

namespace lightwell::testing {
namespace {

constexpr std::array kMethods{Method::kThesis, Method::kRealtime, Method::kReference};
PlacedCamera inside() {
  return look_at({0, 0, 0.9f}, {0, 0, -1}, 1.2f);
}

/// All views by all methods. A method that this build refuses must be refused by name.
void expect_finite(const Scene& scene, const PlacedCamera& camera, Settings settings = {}) {
  settings.samples = 4;
  settings.indirect_size = 16;
  settings.shadow_size = 64;
  for (const Method method : kMethods)
    for (const ViewKind view : all_view_kinds()) {
      if (view == ViewKind::kBounce && settings.bounces == 0) continue;  // there is none to see
      if (view >= ViewKind::kHistory && (method != Method::kRealtime || settings.bounces == 0)) continue;  // nor here
      settings.method = method;
      settings.view = view;
      settings.view_index = view == ViewKind::kBounce ? 1 : 0;
      SCOPED_TRACE(::testing::Message() << name_of(method) << ", view " << name_of(view));
      const Status accepted = check_settings(settings, {16, 16});
      if (accepted.ok())
        render(scene, camera, settings, {16, 16}, 2);
      else
        EXPECT_EQ(accepted.error().where, "method");
    }
}

Scene room_of(const Material& material, float candela = 3.0f) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(material));
  maker.point({0.2f, 0.3f, 0.1f}, candela);
  return maker.take();
}

Settings with_bounces(int bounces) {
  Settings settings;
  settings.bounces = bounces;
  return settings;
}

TEST(FiniteOutputs, OfEmissionBeyondMeasure) {
  Material bright = lambert(glm::vec3(0.9f), glm::vec3(1.0f));
  for (const float strength : {1e30f, std::numeric_limits<float>::max()}) {
    bright.emissive_strength = strength;
    SCOPED_TRACE(strength);
    expect_finite(room_of(bright), inside(), with_bounces(2));
  }
}

TEST(FiniteOutputs, OfLightsBeyondMeasureAndWithoutEnergy) {
  for (const float candela : {0.0f, 1e-38f, 1e30f, std::numeric_limits<float>::max()}) {
    SCOPED_TRACE(candela);
    expect_finite(room_of(lambert(glm::vec3(0.5f)), candela), inside(), with_bounces(2));
  }
  expect_finite(room_of(lambert(glm::vec3(0.5f))), inside(), with_bounces(0));
}

TEST(FiniteOutputs, OfAllRoughnessAndMetalness) {
  for (const float roughness : {0.0f, 1.0f, -3.0f, 7.0f})
    for (const float metallic : {0.0f, 1.0f, 5.0f}) {
      Material material;
      material.roughness_factor = roughness;
      material.metallic_factor = metallic;
      SCOPED_TRACE(::testing::Message() << "roughness " << roughness << ", metallic " << metallic);
      expect_finite(room_of(material), inside());
    }
}

TEST(FiniteOutputs, OfAllLobes) {
  Material material;
  material.metallic_factor = 0.0f;
  material.roughness_factor = 0.0f;
  material.clearcoat_factor = 1.0f;
  material.sheen_color_factor = glm::vec3(1.0f);
  material.transmission_factor = 1.0f;
  material.thickness_factor = 1.0f;
  material.attenuation_color = glm::vec3(0.0f);
  material.attenuation_distance = 1e-30f;
  expect_finite(room_of(material), inside(), with_bounces(2));
}

TEST(FiniteOutputs, OfCamerasInGeometryAndWithoutADirection) {
  const Scene scene = room_of(lambert(glm::vec3(0.5f)));
  expect_finite(scene, look_at({5, 0, 0}, {6, 0, 0}));    // outside, looking away
  expect_finite(scene, look_at({1, 1, 1}, {0, 0, 0}));    // in a corner
  expect_finite(scene, look_at({0, -1, 0}, {1, -1, 0}));  // in the plane of the floor
  PlacedCamera flat = inside();
  flat.world_from_view[0] = glm::vec4(0.0f);
  expect_finite(scene, flat);
  PlacedCamera point = inside();
  point.world_from_view = glm::mat4(0.0f);
  point.world_from_view[3][3] = 1.0f;
  expect_finite(scene, point);
}

TEST(FiniteOutputs, OfTrianglesAndEmittersWithoutArea) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.5f))));
  const int emitter = maker.material(lambert(glm::vec3(0.0f), glm::vec3(9.0f)));
  maker.triangles({{0, 0.5f, 0}, {0, 0.5f, 0}, {0, 0.5f, 0}, {0.5f, 0.5f, 0}}, {0, 1, 2, 0, 1, 3}, emitter);
  maker.triangles({{0, 0, 0}, {1e-30f, 0, 0}, {0, 1e-30f, 0}}, {0, 1, 2}, emitter);
  expect_finite(maker.take(), inside());
}

TEST(FiniteOutputs, OfSkiesAndEmptyScenes) {
  expect_finite(Scene{}, inside());
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 1.0f, 8, false, maker.material(Material{}));
  Scene scene = maker.take();
  add_white_sky(scene);
  expect_finite(scene, look_at({0, 0, 3}, {0, 0, 0}));
  scene.environment.strength = 1e30f;
  expect_finite(scene, look_at({0, 0, 3}, {0, 0, 0}));
  auto image = std::make_shared<ImageHdr>();
  image->size_px = {2, 1};
  image->rgb = {0, 0, 0, 1e9f, 1e9f, 1e9f};  // the most that a file may hold
  scene.environment.image = image;
  expect_finite(scene, look_at({0, 0, 3}, {0, 0, 0}));
}

TEST(FiniteOutputs, WithEverySettingThatHasAPathOfItsOwn) {
  const Scene scene = varied_room();
  Settings settings = with_bounces(3);
  settings.multiple_scattering = true;
  expect_finite(scene, before_varied_room(), settings);
  settings.denoise = true;
  expect_finite(scene, before_varied_room(), settings);
  settings.estimator = Estimator::kLiteral;
  expect_finite(scene, before_varied_room(), settings);
  settings = with_bounces(1);
  for (const LightStrategy strategy : {LightStrategy::kLights, LightStrategy::kRays}) {
    settings.light_strategy = strategy;
    expect_finite(scene, before_varied_room(), settings);
  }
}

}  // namespace
}  // namespace lightwell::testing
