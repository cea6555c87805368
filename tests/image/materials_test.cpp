// Materials in whole pictures: textures, shading normals and lobes where what must be seen is known.
#include <gtest/gtest.h>

#include <cmath>

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

void add_white_sky(Scene& scene) {
  scene.environment.zenith_radiance = scene.environment.horizon_radiance = scene.environment.ground_radiance =
      glm::vec3(1.0f);
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

// Far outside a texture that clamps, its edge alone is seen, however small the picture of it is.
TEST(Textures, ClampedOnesShowTheirEdgeAtEveryLevel) {
  auto image = std::make_shared<Image>();
  image->size_px = {64, 64};
  for (int i = 0; i < 64 * 64; ++i)
    for (const int value : {i % 64 < 16 ? 0 : 255, i % 64 < 16 ? 255 : 0, 0, 255})  // green left, red right
      image->rgba.push_back(static_cast<std::uint8_t>(value));
  Material material = lambert(glm::vec3(1.0f));
  material.base_color_texture.texture = 0;
  SceneMaker maker;
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(material));
  Scene scene = maker.take();
  scene.images.push_back(image);
  scene.textures.push_back({"", 0, {.wrap_s = Wrap::kClampToEdge, .wrap_t = Wrap::kRepeat}});
  std::shared_ptr<Mesh> mesh;
  Primitive& quad = only_primitive(scene, mesh);
  quad.uv0 = {{-9, 0}, {-1, 0}, {-1, 8}, {-9, 8}};
  add_white_sky(scene);
  const Pixels pixels = render(scene, look_at({0, 0, 2}, {0, 0, 0}), one_bounce());
  EXPECT_GT(pixels.center().g, 0.9f);
  EXPECT_LT(pixels.center().r, 0.01f);
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

}  // namespace
}  // namespace lightwell::testing
