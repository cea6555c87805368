// Nodes, scenes, materials, lights, cameras and animations from glTF, against values worked out by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/gltf_builder.h"

namespace lightwell {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Scene loaded(const GltfBuilder& builder, const LoadLimits& limits = {}) {
  Result<Scene> scene = builder.load(limits);
  if (!scene) {
    ADD_FAILURE() << scene.error().message();
    return {};
  }
  return std::move(*scene);
}

TEST(GltfNodes, HierarchyAndTransforms) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["nodes"][0]["name"] = "leaf";
  builder.root["nodes"][0]["translation"] = {1, 2, 3};
  builder.root["nodes"][0]["rotation"] = {0, 0, 2, 0};  // half a turn about z, not of unit length
  builder.root["nodes"][0]["scale"] = {2, 2, 2};
  builder.add("nodes", {{"name", "root"}, {"children", {0}}});
  const Scene scene = loaded(builder);
  EXPECT_THAT(scene.roots, ElementsAre(1));
  EXPECT_EQ(scene.nodes[0].name, "leaf");
  EXPECT_EQ(scene.nodes[0].parent, 1);
  EXPECT_EQ(scene.nodes[0].local.translation, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.nodes[0].local.rotation, glm::quat(0, 0, 0, 1));
  EXPECT_EQ(scene.nodes[0].local.scale, glm::vec3(2, 2, 2));
  EXPECT_FALSE(scene.nodes[0].matrix.has_value());
  EXPECT_THAT(scene.nodes[1].children, ElementsAre(0));
  EXPECT_EQ(scene.nodes[1].mesh, -1);
}

TEST(GltfNodes, MatricesAreByColumns) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 4, 5, 6, 1};
  const Scene scene = loaded(builder);
  ASSERT_TRUE(scene.nodes[0].matrix.has_value());
  EXPECT_EQ((*scene.nodes[0].matrix)[3], glm::vec4(4, 5, 6, 1));
  EXPECT_EQ((*scene.nodes[0].matrix)[1], glm::vec4(0, 2, 0, 0));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(GltfNodes, ARotationWithoutLengthIsNone) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.nodes[0].local.rotation, glm::quat(1, 0, 0, 0));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("nodes/0: the rotation")));
}

TEST(GltfNodes, ADeepHierarchyIsNoProblem) {
  GltfBuilder builder = GltfBuilder::triangle();
  for (int i = 1; i < 50'000; ++i) builder.add("nodes", {{"children", {i - 1}}});
  const Scene scene = loaded(builder);
  EXPECT_THAT(scene.roots, ElementsAre(49'999));
}

TEST(GltfScenes, TheDefaultSceneIsShown) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("nodes", {{"mesh", 0}});
  builder.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}, {"name", "second"}}};
  builder.root["scene"] = 1;
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.name, "second");
  EXPECT_THAT(scene.roots, ElementsAre(1));
  EXPECT_EQ(scene.nodes[0].mesh, -1) << "a node of another scene must show nothing";
  EXPECT_EQ(scene.nodes[1].mesh, 0);
  EXPECT_EQ(count_triangles(scene), 1u);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("of 2 scenes only number 1")));
}

TEST(GltfScenes, TheFirstIsShownByDefault) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("nodes", {{"mesh", 0}});
  builder.root["scenes"] = {{{"nodes", {1}}}};
  EXPECT_THAT(loaded(builder).roots, ElementsAre(1));
}

TEST(GltfNodes, Visibility) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_FALSE(loaded(builder).nodes[0].visible);
}

TEST(GltfNodes, WeightsOfAnInstance) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
  builder.root["nodes"][0]["weights"] = {0.5, 1};
  EXPECT_THAT(loaded(builder).nodes[0].weights, ElementsAre(0.5f, 1.0f));
  builder.root["nodes"][0]["weights"] = {0.5};
  const Scene scene = loaded(builder);
  EXPECT_THAT(scene.nodes[0].weights, IsEmpty());
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("1 weights for 2 morph targets")));
}

TEST(GltfInstancing, BecomesChildren) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", builder.add_accessor<float>({1, 0, 0, 2, 0, 0}, "VEC3")},
      {"ROTATION", builder.add_accessor<std::int8_t>({0, 0, 0, 127, 0, 127, 0, 0}, "VEC4", true)},
      {"_ID", builder.add_accessor<float>({1, 2}, "SCALAR")}};
  const Scene scene = loaded(builder);
  ASSERT_THAT(scene.nodes, SizeIs(3));
  EXPECT_EQ(scene.nodes[0].mesh, -1);
  EXPECT_THAT(scene.nodes[0].children, ElementsAre(1, 2));
  EXPECT_EQ(scene.nodes[2].parent, 0);
  EXPECT_EQ(scene.nodes[2].mesh, 0);
  EXPECT_EQ(scene.nodes[2].local.translation, glm::vec3(2, 0, 0));
  EXPECT_EQ(scene.nodes[2].local.rotation, glm::quat(0, 0, 1, 0));
  EXPECT_EQ(scene.nodes[2].local.scale, glm::vec3(1, 1, 1));
  EXPECT_EQ(count_triangles(scene), 2u);
}

TEST(GltfMaterials, DefaultsAreGltfs) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("materials", json::object());
  const Material material = loaded(builder).materials[0];
  EXPECT_EQ(material.base_color_factor, glm::vec4(1));
  EXPECT_EQ(material.metallic_factor, 1.0f);
  EXPECT_EQ(material.roughness_factor, 1.0f);
  EXPECT_EQ(material.emissive_factor, glm::vec3(0));
  EXPECT_EQ(material.alpha_mode, AlphaMode::kOpaque);
  EXPECT_EQ(material.alpha_cutoff, 0.5f);
  EXPECT_FALSE(material.double_sided);
  EXPECT_EQ(material.base_color_texture.texture, -1);
}

TEST(GltfMaterials, FactorsAndTextures) {
  GltfBuilder builder = GltfBuilder::triangle();
  for (int i = 0; i < 5; ++i) builder.add_texture();
  builder.add("materials", {{"name", "all"},
                            {"pbrMetallicRoughness",
                             {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                              {"baseColorTexture", {{"index", 0}, {"texCoord", 1}}},
                              {"metallicFactor", 0.5},
                              {"roughnessFactor", 0.25},
                              {"metallicRoughnessTexture", {{"index", 1}}}}},
                            {"normalTexture", {{"index", 2}, {"scale", 0.75}}},
                            {"occlusionTexture", {{"index", 3}, {"strength", 0.125}}},
                            {"emissiveTexture", {{"index", 4}}},
                            {"emissiveFactor", {1, 0.5, 0}},
                            {"alphaMode", "MASK"},
                            {"alphaCutoff", 0.3},
                            {"doubleSided", true}});
  const Scene scene = loaded(builder);
  const Material& material = scene.materials[0];
  EXPECT_EQ(material.name, "all");
  EXPECT_EQ(material.base_color_factor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallic_factor, 0.5f);
  EXPECT_EQ(material.roughness_factor, 0.25f);
  EXPECT_EQ(material.normal_scale, 0.75f);
  EXPECT_EQ(material.occlusion_strength, 0.125f);
  EXPECT_EQ(material.emissive_factor, glm::vec3(1, 0.5f, 0));
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(material.alpha_cutoff, 0.3f);
  EXPECT_TRUE(material.double_sided);
  EXPECT_EQ(material.base_color_texture.texture, 0);
  EXPECT_EQ(material.base_color_texture.uv_set, 1);
  EXPECT_EQ(material.metallic_roughness_texture.texture, 1);
  EXPECT_EQ(material.normal_texture.texture, 2);
  EXPECT_EQ(material.occlusion_texture.texture, 3);
  EXPECT_EQ(material.emissive_texture.texture, 4);
  ASSERT_THAT(scene.images, SizeIs(5));
  EXPECT_THAT(scene.images[4]->rgba, ElementsAre(255, 255, 255, 255));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(GltfMaterials, FactorsOutOfRangeAreClamped) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("materials",
              {{"pbrMetallicRoughness", {{"metallicFactor", -1}, {"roughnessFactor", 1e300}}}, {"alphaMode", "GLASS"}});
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.materials[0].metallic_factor, 0.0f);
  EXPECT_EQ(scene.materials[0].roughness_factor, 1.0f);
  EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::kOpaque);
  EXPECT_THAT(scene.warnings, ElementsAre("materials/0/pbrMetallicRoughness: metallicFactor is -1; 0 is used",
                                          "materials/0/pbrMetallicRoughness: roughnessFactor is 1e+300; 1 is used",
                                          HasSubstr("alphaMode 'GLASS'")));
}

TEST(GltfMaterials, Extensions) {
  GltfBuilder builder = GltfBuilder::triangle();
  const json texture{{"index", builder.add_texture()}};
  builder.add("materials",
              {{"extensions",
                {{"KHR_materials_unlit", json::object()},
                 {"KHR_materials_emissive_strength", {{"emissiveStrength", 70000000000}}},  // more than an int holds
                 {"KHR_materials_ior", {{"ior", 1.33}}},
                 {"KHR_materials_specular",
                  {{"specularFactor", 0.5},
                   {"specularColorFactor", {2, 1, 0}},
                   {"specularTexture", texture},
                   {"specularColorTexture", texture}}},
                 {"KHR_materials_transmission", {{"transmissionFactor", 0.75}, {"transmissionTexture", texture}}},
                 {"KHR_materials_volume",
                  {{"thicknessFactor", 2}, {"attenuationDistance", 3}, {"attenuationColor", {0.1, 0.2, 0.3}}}},
                 {"KHR_materials_clearcoat",
                  {{"clearcoatFactor", 1},
                   {"clearcoatRoughnessFactor", 0.5},
                   {"clearcoatTexture", texture},
                   {"clearcoatRoughnessTexture", texture},
                   {"clearcoatNormalTexture", {{"index", 0}, {"scale", 0.5}, {"texCoord", 1}}}}},
                 {"KHR_materials_sheen",
                  {{"sheenColorFactor", {0.5, 0, 0}},
                   {"sheenRoughnessFactor", 0.25},
                   {"sheenColorTexture", texture},
                   {"sheenRoughnessTexture",
                    {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 3}}}}}}}}}}}}});
  const Scene scene = loaded(builder);
  const Material& material = scene.materials[0];
  EXPECT_TRUE(material.unlit);
  EXPECT_EQ(material.emissive_strength, 7e10f);
  EXPECT_EQ(material.ior, 1.33f);
  EXPECT_EQ(material.specular_factor, 0.5f);
  EXPECT_EQ(material.specular_color_factor, glm::vec3(2, 1, 0));
  EXPECT_EQ(material.transmission_factor, 0.75f);
  EXPECT_EQ(material.thickness_factor, 2.0f);
  EXPECT_EQ(material.attenuation_distance, 3.0f);
  EXPECT_EQ(material.attenuation_color, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(material.clearcoat_factor, 1.0f);
  EXPECT_EQ(material.clearcoat_roughness, 0.5f);
  EXPECT_EQ(material.sheen_color_factor, glm::vec3(0.5f, 0, 0));
  EXPECT_EQ(material.sheen_roughness, 0.25f);
  for (const TextureUse* use :
       {&material.specular_texture, &material.specular_color_texture, &material.transmission_texture,
        &material.clearcoat_texture, &material.clearcoat_roughness_texture, &material.clearcoat_normal_texture,
        &material.sheen_color_texture, &material.sheen_roughness_texture})
    EXPECT_EQ(use->texture, 0);
  EXPECT_EQ(material.clearcoat_normal_scale, 0.5f);
  EXPECT_EQ(material.clearcoat_normal_texture.uv_set, 1);
  EXPECT_EQ(material.sheen_roughness_texture.scale, glm::vec2(2, 3));
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(scene.images, SizeIs(1));
}

TEST(GltfMaterials, LightBeyondAnyMeasureIsClamped) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("materials", {{"emissiveFactor", {1, 1, 1}},
                            {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e30}}}}}});
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.materials[0].emissive_strength, 1e15f);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("emissiveStrength is 1e+30; 1e+15 is used")));
}

TEST(GltfTextures, Transform) {
  GltfBuilder builder = GltfBuilder::triangle();
  const json transform{{"offset", {0.5, -1}}, {"rotation", 1.5}, {"scale", {2, 3}}, {"texCoord", 1}};
  builder.add("materials",
              {{"emissiveTexture",
                {{"index", builder.add_texture()}, {"extensions", {{"KHR_texture_transform", transform}}}}}});
  const TextureUse use = loaded(builder).materials[0].emissive_texture;
  EXPECT_EQ(use.offset, glm::vec2(0.5f, -1));
  EXPECT_EQ(use.rotation, 1.5f);
  EXPECT_EQ(use.scale, glm::vec2(2, 3));
  EXPECT_EQ(use.uv_set, 1);
}

TEST(GltfTextures, ThirdCoordinatesFallBackToTheFirst) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("materials", {{"emissiveTexture", {{"index", builder.add_texture()}, {"texCoord", 2}}}});
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.materials[0].emissive_texture.uv_set, 0);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("texture coordinates 2")));
}

TEST(GltfTextures, Samplers) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("samplers", {{"magFilter", 9728}, {"minFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}});
  builder.add("samplers", {{"magFilter", 9729}, {"minFilter", 9984}});
  builder.add("samplers", {{"minFilter", 9729}, {"wrapS", 7}});
  for (int i = 0; i < 4; ++i) builder.add("textures", {{"sampler", i}});
  builder.root["textures"][3].erase("sampler");
  const Scene scene = loaded(builder);
  EXPECT_TRUE(scene.textures[0].sampler.mag_nearest);
  EXPECT_TRUE(scene.textures[0].sampler.min_nearest);
  EXPECT_FALSE(scene.textures[0].sampler.mipmapped);
  EXPECT_EQ(scene.textures[0].sampler.wrap_s, Wrap::kClampToEdge);
  EXPECT_EQ(scene.textures[0].sampler.wrap_t, Wrap::kMirroredRepeat);
  EXPECT_FALSE(scene.textures[1].sampler.mag_nearest);
  EXPECT_TRUE(scene.textures[1].sampler.min_nearest);
  EXPECT_TRUE(scene.textures[1].sampler.mipmapped);
  EXPECT_FALSE(scene.textures[2].sampler.min_nearest);
  EXPECT_FALSE(scene.textures[2].sampler.mipmapped);
  EXPECT_EQ(scene.textures[3].sampler.wrap_s, Wrap::kRepeat);
  EXPECT_TRUE(scene.textures[3].sampler.mipmapped);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("samplers/2/wrapS: 7")));
}

TEST(GltfTextures, ImagesAreSharedAndUnusedOnesLeftOut) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add_image(to_bytes({'n', 'o', ' ', 'i', 'm', 'a', 'g', 'e'}));  // never looked at
  builder.add_texture();
  builder.add("textures", {{"source", 1}});
  builder.add("textures", {{"source", 0}});
  builder.add("materials", {{"emissiveTexture", {{"index", 0}}}, {"occlusionTexture", {{"index", 1}}}});
  const Scene scene = loaded(builder);
  EXPECT_THAT(scene.images, SizeIs(1));
  EXPECT_EQ(scene.textures[0].image, 0);
  EXPECT_EQ(scene.textures[1].image, 0);
  EXPECT_EQ(scene.textures[2].image, -1);
}

TEST(GltfTextures, ATextureWithoutImageIsNotUsed) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("textures", json::object());
  builder.add("materials", {{"emissiveTexture", {{"index", 0}}}});
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.materials[0].emissive_texture.texture, -1);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("has no image")));
}

GltfBuilder with_light(json light) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {std::move(light)};
  builder.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  return builder;
}

TEST(GltfLights, OfAllKinds) {
  Scene scene =
      loaded(with_light({{"type", "directional"}, {"name", "sun"}, {"intensity", 1000}, {"color", {1, 0.5, 0}}}));
  EXPECT_EQ(scene.nodes[0].light, 0);
  EXPECT_EQ(scene.lights[0].kind, LightKind::kDirectional);
  EXPECT_EQ(scene.lights[0].name, "sun");
  EXPECT_EQ(scene.lights[0].intensity, 1000.0f);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1, 0.5f, 0));
  scene = loaded(with_light({{"type", "point"}, {"range", 5}}));
  EXPECT_EQ(scene.lights[0].kind, LightKind::kPoint);
  EXPECT_EQ(scene.lights[0].range_m, 5.0f);
  EXPECT_EQ(scene.lights[0].intensity, 1.0f);
  scene = loaded(with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}));
  EXPECT_EQ(scene.lights[0].kind, LightKind::kSpot);
  EXPECT_EQ(scene.lights[0].inner_cone_angle, 0.25f);
  EXPECT_EQ(scene.lights[0].outer_cone_angle, 0.5f);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(GltfLights, AreMadeLegal) {
  Scene scene = loaded(with_light({{"type", "point"}, {"intensity", -3}, {"color", {-1, 0, 0}}}));
  EXPECT_EQ(scene.lights[0].intensity, 0.0f);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(0));
  EXPECT_THAT(scene.warnings, SizeIs(2));
  scene = loaded(with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 1}, {"outerConeAngle", 0.5}}}}));
  EXPECT_LT(scene.lights[0].inner_cone_angle, scene.lights[0].outer_cone_angle);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("innerConeAngle is 1")));
  scene = loaded(with_light({{"type", "spot"}, {"spot", {{"outerConeAngle", 3}}}}));
  EXPECT_LE(scene.lights[0].outer_cone_angle, std::numbers::pi_v<float> / 2);
}

TEST(GltfCameras, OfBothKinds) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("cameras", {{"type", "perspective"},
                          {"name", "eye"},
                          {"perspective", {{"yfov", 0.5}, {"znear", 0.25}, {"zfar", 100}, {"aspectRatio", 1.5}}}});
  builder.add("cameras",
              {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 10}}}});
  builder.root["nodes"][0]["camera"] = 1;
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.nodes[0].camera, 1);
  EXPECT_TRUE(scene.cameras[0].perspective);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_EQ(scene.cameras[0].yfov, 0.5f);
  EXPECT_EQ(scene.cameras[0].znear, 0.25f);
  EXPECT_EQ(scene.cameras[0].zfar, 100.0f);
  EXPECT_EQ(scene.cameras[0].aspect_ratio, 1.5f);
  EXPECT_FALSE(scene.cameras[1].perspective);
  EXPECT_EQ(scene.cameras[1].xmag, 2.0f);
  EXPECT_EQ(scene.cameras[1].ymag, 3.0f);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(GltfCameras, AreMadeLegal) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 1}, {"zfar", 0.5}}}});
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.cameras[0].yfov, Camera().yfov);
  EXPECT_EQ(scene.cameras[0].zfar, 0.0f);
  EXPECT_THAT(scene.warnings, SizeIs(2));
}

/// A triangle whose node is animated by one channel.
GltfBuilder animated(const std::string& path, int input, int output, const GltfBuilder& base,
                     const std::string& interpolation = "LINEAR") {
  GltfBuilder builder = base;
  builder.add("animations", {{"name", "motion"},
                             {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
                             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
  return builder;
}

TEST(GltfAnimation, Translation) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0, 2}, "SCALAR");
  const int output = builder.add_accessor<float>({1, 2, 3, 4, 5, 6}, "VEC3");
  const Scene scene = loaded(animated("translation", input, output, builder, "STEP"));
  EXPECT_EQ(scene.animations[0].name, "motion");
  EXPECT_EQ(scene.animations[0].duration_s, 2.0f);
  const AnimationChannel& channel = scene.animations[0].channels[0];
  EXPECT_EQ(channel.node, 0);
  EXPECT_EQ(channel.property, AnimatedProperty::kTranslation);
  EXPECT_EQ(channel.interpolation, Interpolation::kStep);
  EXPECT_EQ(channel.width, 3);
  EXPECT_THAT(channel.times_s, ElementsAre(0, 2));
  EXPECT_THAT(channel.values, ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(GltfAnimation, RotationsAreOfUnitLength) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0, 1, 2}, "SCALAR");
  const int output = builder.add_accessor<std::int16_t>({0, 0, 0, 32767, 0, 16384, 0, 0, 0, 0, 0, 0}, "VEC4", true);
  const Scene scene = loaded(animated("rotation", input, output, builder));
  EXPECT_THAT(scene.animations[0].channels[0].values, ElementsAre(0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("rotations without length")));
}

TEST(GltfAnimation, CubicSplinesHaveThreeValuesAKey) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0.5f}, "SCALAR");
  const int output = builder.add_accessor<float>({9, 9, 9, 9, 0, 0, 2, 0, 8, 8, 8, 8}, "VEC4");
  const Scene scene = loaded(animated("rotation", input, output, builder, "CUBICSPLINE"));
  EXPECT_EQ(scene.animations[0].channels[0].interpolation, Interpolation::kCubicSpline);
  EXPECT_THAT(scene.animations[0].channels[0].values, ElementsAre(9, 9, 9, 9, 0, 0, 1, 0, 8, 8, 8, 8));
}

TEST(GltfAnimation, Weights) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
  const int input = builder.add_accessor<float>({0, 1}, "SCALAR");
  const int output = builder.add_accessor<std::uint8_t>({0, 255, 51, 0}, "SCALAR", true);
  const Scene scene = loaded(animated("weights", input, output, builder));
  EXPECT_EQ(scene.animations[0].channels[0].width, 2);
  EXPECT_THAT(scene.animations[0].channels[0].values, ElementsAre(0, 1, 0.2f, 0));
}

TEST(GltfAnimation, KeysThatDoNotAscendAreLeftOut) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0, 1, 1, 0.5f, 2}, "SCALAR");
  const int output = builder.add_accessor<float>({0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}, "VEC3");
  const Scene scene = loaded(animated("scale", input, output, builder));
  EXPECT_THAT(scene.animations[0].channels[0].times_s, ElementsAre(0, 1, 2));
  EXPECT_THAT(scene.animations[0].channels[0].values, ElementsAre(0, 0, 0, 1, 1, 1, 4, 4, 4));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("2 keys")));
}

TEST(GltfAnimation, WhatNothingCanFollowIsLeftOut) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0}, "SCALAR");
  const int output = builder.add_accessor<float>({0, 0, 0}, "VEC3");
  Scene scene = loaded(animated("weights", input, output, builder));
  EXPECT_THAT(scene.animations[0].channels, IsEmpty());
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("morph targets that do not exist")));
  scene = loaded(animated("pointer", input, output, builder));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("animates 'pointer'")));
  GltfBuilder untargeted = animated("translation", input, output, builder);
  untargeted.root["animations"][0]["channels"][0]["target"].erase("node");
  scene = loaded(untargeted);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("animations/0: channels that target no node")));
  builder.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  scene = loaded(animated("translation", input, output, builder));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("has a matrix")));
}

TEST(GltfExtensions, UnknownOnes) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["extensionsUsed"] = {"VENDOR_new_thing", "KHR_materials_unlit"};
  EXPECT_THAT(loaded(builder).warnings, ElementsAre(HasSubstr("'VENDOR_new_thing' is ignored")));
  builder.root["extensionsRequired"] = {"KHR_materials_unlit", "VENDOR_new_thing"};
  const Result<Scene> scene = builder.load();
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().kind, ErrorKind::kUnsupported);
  EXPECT_EQ(scene.error().where, "extensionsRequired/1");
  EXPECT_THAT(scene.error().what, HasSubstr("VENDOR_new_thing"));
}

TEST(GltfExtensions, ExtrasAndUnknownMembersAreOfNoAccount) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["extras"] = {{"count", -1}, {"mesh", "yes"}};
  builder.root["nodes"][0]["extras"] = 5;
  builder.root["nodes"][0]["extensions"]["VENDOR_thing"] = {1, 2, 3};
  builder.root["somethingNew"] = {{"nodes", "none"}};
  EXPECT_THAT(loaded(builder).warnings, IsEmpty());
}

TEST(GltfWarnings, AreNotEndless) {
  GltfBuilder builder = GltfBuilder::triangle();
  for (int i = 0; i < 1000; ++i) builder.add("materials", {{"alphaMode", "NONE"}});
  const Scene scene = loaded(builder);
  EXPECT_THAT(scene.warnings, SizeIs(101));
  EXPECT_THAT(scene.warnings, Contains("and 900 more warnings"));
}

}  // namespace
}  // namespace lightwell
