// Materials and textures from glTF, against values worked out by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gltf_loaded.h"

namespace lightwell {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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

}  // namespace
}  // namespace lightwell
