// Materials in whole pictures: textures, shading normals and lobes where what must be seen is known.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/type_precision.hpp>

#include "tests/image/test_scenes.h"

namespace lightwell::testing {
namespace {

Settings one_bounce() {
  Settings settings;
  settings.bounces = 1;
  settings.samples = 256;
  settings.indirect_size = 32;
  return settings;
}

Primitive& only_primitive(Scene& scene, std::shared_ptr<Mesh>& copy) {
  copy = std::make_shared<Mesh>(*scene.meshes.at(0));
  scene.meshes.at(0) = copy;
  return copy->primitives.at(0);
}

Material metal(float roughness) {
  Material material;
  material.metallic_factor = 1.0f;
  material.roughness_factor = roughness;
  return material;
}

constexpr glm::u8vec4 kRed(255, 0, 0, 255), kGreen(0, 255, 0, 255), kBlue(0, 0, 255, 255);

/// A white quad that faces +Z under a white sky, with a picture of 64 x 64 texels.
Scene textured_quad(const std::function<glm::u8vec4(int x, int y)>& texel, const TextureUse& use,
                    const Sampler& sampler, std::vector<glm::vec2> uv) {
  Material material = lambert(glm::vec3(1.0f));
  material.base_color_texture = use;
  SceneMaker maker;
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(material));
  Scene scene = maker.take();
  auto image = std::make_shared<Image>();
  image->size_px = {64, 64};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int channel = 0; channel < 4; ++channel) image->rgba.push_back(texel(x, y)[channel]);
  scene.images.push_back(image);
  scene.textures.push_back({"", 0, sampler});
  std::shared_ptr<Mesh> mesh;
  only_primitive(scene, mesh).uv0 = std::move(uv);
  add_white_sky(scene);
  return scene;
}

// Far outside a texture that clamps, its edge alone is seen, however small the picture of it is.
TEST(Textures, ClampedOnesShowTheirEdgeAtEveryLevel) {
  const Sampler clamped{.wrap_s = Wrap::kClampToEdge, .wrap_t = Wrap::kRepeat};
  const Scene scene = textured_quad([](int x, int) { return x < 16 ? kGreen : kRed; }, {.texture = 0}, clamped,
                                    {{-9, 0}, {-1, 0}, {-1, 8}, {-9, 8}});
  const Pixels pixels = render(scene, look_at({0, 0, 2}, {0, 0, 0}), one_bounce());
  EXPECT_GT(pixels.center().g, 0.9f);
  EXPECT_LT(pixels.center().r, 0.01f);
}

// The example in KHR_texture_transform's text: half a scale, a quarter turn and an offset of one down show the lower
// left quarter of the picture, and nothing else.
TEST(Textures, TurnTheWayTheExtensionSays) {
  const TextureUse turned{.texture = 0, .offset = {0.0f, 1.0f}, .rotation = 1.57079632679f, .scale = glm::vec2(0.5f)};
  const Sampler repeated{.wrap_s = Wrap::kRepeat, .wrap_t = Wrap::kRepeat};
  const Scene scene = textured_quad([](int x, int y) { return x < 32 && y >= 32 ? kBlue : kRed; }, turned, repeated,
                                    {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  const Pixels pixels = render(scene, look_at({0, 0, 3}, {0, 0, 0}, 0.3f), one_bounce());
  EXPECT_GT(pixels.mean().b, 0.9f);
  EXPECT_LT(pixels.mean().r, 0.02f);
}

// Vertex normals so far from the face that the mirror direction lies below it, as a normal map may have it.
TEST(ShadingNormals, NeverMakeAMirrorBlack) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(metal(0.1f)));
  Scene scene = maker.take();
  std::shared_ptr<Mesh> mesh;
  Primitive& quad = only_primitive(scene, mesh);
  quad.normals.assign(4, glm::normalize(glm::vec3(0.0f, 0.5f, -1.0f)));
  add_white_sky(scene);
  const Pixels pixels = render(scene, look_at({0, 2, 2}, {0, 0, 0}, 0.1f), one_bounce());
  EXPECT_GT(pixels.center().g, 0.3f);
}

TEST(MultipleScattering, KeepsTheLightThatARoughMetalWouldLose) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(metal(1.0f)));
  Scene scene = maker.take();
  add_white_sky(scene);
  Settings settings = one_bounce();
  const PlacedCamera camera = look_at({0, 3, 0.1f}, {0, 0, 0}, 0.1f);
  EXPECT_LT(render(scene, camera, settings).mean().g, 0.5f);
  settings.multiple_scattering = true;
  EXPECT_NEAR(render(scene, camera, settings).mean().g, 1.0f, 0.02f);
}

// A floor of this material under a white sky, seen from above.
float under_white_sky(const Material& material, bool multiple_scattering = false) {
  SceneMaker maker;
  maker.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, maker.material(material));
  Scene scene = maker.take();
  add_white_sky(scene);
  Settings settings = one_bounce();
  settings.multiple_scattering = multiple_scattering;
  return render(scene, look_at({0, 3, 0.1f}, {0, 0, 0}, 0.1f), settings).mean().g;
}

Material black() {
  Material material = lambert(glm::vec3(0.0f));
  material.roughness_factor = 0.0f;
  return material;
}

TEST(Lobes, AThinPaneOfGlassIsInvisibleInUniformLight) {
  Material glass;
  glass.metallic_factor = 0.0f;
  glass.roughness_factor = 0.1f;
  glass.transmission_factor = 1.0f;
  EXPECT_NEAR(under_white_sky(glass), 1.0f, 0.02f);
  EXPECT_NEAR(under_white_sky(glass, true), 1.0f, 0.02f);
  glass.base_color_factor = {0.5f, 0.5f, 0.5f, 1.0f};
  EXPECT_NEAR(under_white_sky(glass), 0.04f + 0.96f * 0.5f, 0.02f);
}

TEST(Lobes, AClearcoatReflectsFourPercentFromAbove) {
  Material coated = black();
  coated.clearcoat_factor = 1.0f;
  EXPECT_NEAR(under_white_sky(coated), 0.04f, 0.004f);
  coated.clearcoat_factor = 0.5f;
  EXPECT_NEAR(under_white_sky(coated), 0.02f, 0.002f);
}

TEST(Lobes, SheenIsAddedAndTakenFromTheBase) {
  Material velvet = black();
  velvet.sheen_color_factor = glm::vec3(1.0f);
  velvet.sheen_roughness = 0.5f;
  const float sheen = under_white_sky(velvet);
  EXPECT_GT(sheen, 0.01f);
  velvet.base_color_factor = glm::vec4(1.0f);
  const float both = under_white_sky(velvet);
  EXPECT_GT(both, 0.8f);
  EXPECT_LT(both, 1.01f);
}

TEST(Lobes, ASpecularColourTintsTheReflection) {
  Material tinted = black();
  tinted.specular_factor = 1.0f;
  tinted.specular_color_factor = {1.0f, 5.0f, 1.0f};
  EXPECT_NEAR(under_white_sky(tinted), 0.2f, 0.01f);
}

// Light of any strength gives numbers.
TEST(Lobes, EmissionBeyondMeasureStaysFinite) {
  Material bright = lambert(glm::vec3(0.5f), glm::vec3(1.0f));
  bright.emissive_strength = 1e15f;
  EXPECT_GT(under_white_sky(bright), 6e4f);
}

// What of a glowing wall's light comes through two faces of glass a metre apart, looked at along their normals.
glm::vec3 through_a_slab(const Material& glass) {
  SceneMaker maker;
  const int slab = maker.material(glass);
  maker.quad({-5, -5, 0.5f}, {10, 0, 0}, {0, 10, 0}, slab);   // its face towards the camera
  maker.quad({-5, -5, -0.5f}, {0, 10, 0}, {10, 0, 0}, slab);  // and the one away from it
  maker.quad({-20, -20, -3}, {40, 0, 0}, {0, 40, 0}, maker.material(lambert(glm::vec3(0.0f), glm::vec3(1.0f))));
  Settings settings;
  settings.method = Method::kReference;
  settings.bounces = 16;
  return render(maker.take(), look_at({0, 0, 3}, {0, 0, 0}, 0.02f), settings, {32, 32}, 64).mean();
}

// Fresnel's equations at normal incidence, Beer's law between the faces, and all reflections between them.
TEST(Volumes, ASlabOfGlassTransmitsByFresnelAndBeer) {
  Material glass;
  glass.metallic_factor = 0.0f;
  glass.roughness_factor = 0.0f;
  glass.transmission_factor = 1.0f;
  glass.thickness_factor = 1.0f;
  glass.attenuation_color = {1.0f, 0.5f, 0.1f};
  glass.attenuation_distance = 2.0f;
  const float reflected = std::pow(0.5f / 2.5f, 2.0f);
  const glm::vec3 light = through_a_slab(glass);
  for (int c = 0; c < 3; ++c) {
    const float passed = std::sqrt(glass.attenuation_color[c]);  // half the distance
    const float expected =
        (1.0f - reflected) * (1.0f - reflected) * passed / (1.0f - reflected * reflected * passed * passed);
    EXPECT_NEAR(light[c], expected, 0.005f) << "channel " << c;
  }
}

// A body that absorbs nothing is invisible where light comes from everywhere alike, rays within it and all.
TEST(Volumes, ClearGlassLosesNoLight) {
  Material glass;
  glass.metallic_factor = 0.0f;
  glass.roughness_factor = 0.0f;
  glass.transmission_factor = 1.0f;
  glass.thickness_factor = 1.0f;
  SceneMaker maker;
  const int material = maker.material(glass);
  maker.quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, material);
  maker.quad({-1, -1, -1}, {0, 2, 0}, {2, 0, 0}, material);
  maker.quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}, material);
  maker.quad({-1, -1, -1}, {2, 0, 0}, {0, 0, 2}, material);
  maker.quad({1, -1, -1}, {0, 2, 0}, {0, 0, 2}, material);
  maker.quad({-1, -1, -1}, {0, 0, 2}, {0, 2, 0}, material);
  Scene scene = maker.take();
  add_white_sky(scene);
  Settings settings;
  settings.method = Method::kReference;
  settings.bounces = 64;
  const Pixels pixels = render(scene, look_at({3, 2, 4}, {0, 0, 0}, 0.3f), settings, {32, 32}, 32);
  EXPECT_NEAR(pixels.mean().g, 1.0f, 0.01f);
}

// One half of the sky is lit: turning it by half a turn darkens what was lit.
TEST(EnvironmentImage, LightsByItsTexelsAndTurns) {
  auto image = std::make_shared<ImageHdr>();
  image->size_px = {64, 32};
  for (int i = 0; i < 64 * 32; ++i)
    for (int c = 0; c < 3; ++c) image->rgb.push_back(i % 64 < 32 ? 1.0f : 0.0f);  // -X, left of the middle towards -Z
  const auto lit_from_the_left = [&](float rotation, float strength) {
    SceneMaker maker;
    maker.quad({0, -5, -5}, {0, 0, 10}, {0, 10, 0}, maker.material(lambert(glm::vec3(0.5f))));  // faces -X
    Scene scene = maker.take();
    scene.environment.image = image;
    scene.environment.rotation = rotation;
    scene.environment.strength = strength;
    return render(scene, look_at({-3, 0, 0}, {0, 0, 0}, 0.1f), one_bounce()).mean().g;
  };
  EXPECT_NEAR(lit_from_the_left(0.0f, 1.0f), 0.5f, 0.02f);
  EXPECT_NEAR(lit_from_the_left(0.0f, 3.0f), 1.5f, 0.06f);
  EXPECT_NEAR(lit_from_the_left(3.14159265f, 1.0f), 0.0f, 0.02f);
}

}  // namespace
}  // namespace lightwell::testing
