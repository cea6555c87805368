// Edits of materials, lights, cameras and the environment, and the scene's description.
#include "renderer/scene/builtin.h"
#include "tests/unit/edit_scene.h"

namespace lightwell {
namespace {

const std::string kLights = "/extensions/KHR_lights_punctual/lights/";
const std::string kEnvironment = "/extensions/LIGHTWELL_environment";

TEST(MaterialEdits, SetEveryProperty) {
  const Json properties{
      {"/name", "all"},
      {"/pbrMetallicRoughness/baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
      {"/pbrMetallicRoughness/metallicFactor", 0.5},
      {"/pbrMetallicRoughness/roughnessFactor", 0.25},
      {"/pbrMetallicRoughness/baseColorTexture/index", 1},
      {"/pbrMetallicRoughness/baseColorTexture/texCoord", 1},
      {"/pbrMetallicRoughness/metallicRoughnessTexture/index", 0},
      {"/normalTexture/index", 1},
      {"/normalTexture/scale", -2.5},
      {"/normalTexture/extensions/KHR_texture_transform/offset", {0.5, -1}},
      {"/normalTexture/extensions/KHR_texture_transform/rotation", 1.5},
      {"/normalTexture/extensions/KHR_texture_transform/scale", {2, 3}},
      {"/occlusionTexture/index", 0},
      {"/occlusionTexture/strength", 0.75},
      {"/emissiveTexture/index", 1},
      {"/emissiveFactor", {1, 0.5, 0}},
      {"/alphaMode", "MASK"},
      {"/alphaCutoff", 0.3},
      {"/doubleSided", true},
      {"/extensions/KHR_materials_unlit", Json::object()},
      {"/extensions/KHR_materials_emissive_strength/emissiveStrength", 5000},
      {"/extensions/KHR_materials_ior/ior", 1.33},
      {"/extensions/KHR_materials_specular/specularFactor", 0.9},
      {"/extensions/KHR_materials_specular/specularColorFactor", {2, 1, 0}},
      {"/extensions/KHR_materials_transmission/transmissionFactor", 1},
      {"/extensions/KHR_materials_volume/thicknessFactor", 0.01},
      {"/extensions/KHR_materials_volume/attenuationDistance", 3},
      {"/extensions/KHR_materials_volume/attenuationColor", {0.9, 0.8, 0.7}},
      {"/extensions/KHR_materials_clearcoat/clearcoatFactor", 0.6},
      {"/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 0.1},
      {"/extensions/KHR_materials_sheen/sheenColorFactor", {0.1, 0.1, 0.2}},
      {"/extensions/KHR_materials_sheen/sheenRoughnessFactor", 0.4},
      {"/extensions/KHR_materials_specular/specularTexture/index", 0},
      {"/extensions/KHR_materials_specular/specularColorTexture/index", 1},
      {"/extensions/KHR_materials_transmission/transmissionTexture/index", 0},
      {"/extensions/KHR_materials_clearcoat/clearcoatTexture/index", 1},
      {"/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture/texCoord", 1},
      {"/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", 0.5},
      {"/extensions/KHR_materials_sheen/sheenColorTexture/extensions/KHR_texture_transform/offset", {0.5, 0.25}},
      {"/extensions/KHR_materials_sheen/sheenRoughnessTexture/index", 0},
  };
  Scene one_by_one = make_edit_scene(), at_once = make_edit_scene();
  Json whole = Json::object();
  for (const auto& [path, value] : properties.items()) {
    SCOPED_TRACE(path);
    apply_or_fail(one_by_one,
                  patch(edit("replace", "/materials/1" + path, value), edit("test", "/materials/1" + path, value)));
    whole[Json::json_pointer(path)] = value;
  }
  apply_or_fail(at_once, patch(edit("replace", "/materials/green", whole)));
  EXPECT_EQ(describe_scene(one_by_one)["materials"][1], whole);
  EXPECT_EQ(describe_scene(at_once)["materials"][1], whole);

  const Material& material = one_by_one.materials[1];
  EXPECT_EQ(material.base_color_factor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.base_color_texture.uv_set, 1);
  EXPECT_EQ(material.normal_texture.scale, glm::vec2(2, 3));
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_TRUE(material.unlit);
  EXPECT_EQ(material.attenuation_distance, 3.0f);

  for (const auto& [path, value] : properties.items()) apply_or_fail(one_by_one, patch(removal("/materials/1" + path)));
  EXPECT_EQ(describe_scene(one_by_one)["materials"][1], Json::object());
}

TEST(MaterialEdits, RefuseWhatIsOutOfRange) {
  const std::vector<std::pair<std::string, Json>> wrong{
      {"/pbrMetallicRoughness/metallicFactor", 1.01},
      {"/pbrMetallicRoughness/metallicFactor", "1"},
      {"/pbrMetallicRoughness/roughnessFactor", -0.1},
      {"/pbrMetallicRoughness/baseColorTexture/texCoord", 2},
      {"/pbrMetallicRoughness/baseColorTexture/texCoord", 0.5},
      {"/alphaMode", "mask"},
      {"/alphaMode", 1},
      {"/alphaCutoff", -1},
      {"/doubleSided", 1},
      {"/name", nullptr},
      {"/name", std::string(1025, 'x')},
      {"/extensions/KHR_materials_unlit", true},
      {"/extensions/KHR_materials_ior/ior", 0.9},
      {"/extensions/KHR_materials_volume/attenuationDistance", 0},
      {"/extensions/KHR_materials_emissive_strength/emissiveStrength", -1}};
  for (const auto& [path, value] : wrong)
    expect_refused(patch(edit("replace", "/materials/0" + path, value)), ErrorKind::kInvalidInput,
                   "/materials/0" + path);
  expect_refused(patch(edit("replace", "/materials/0/emissiveFactor", {0, 0, 2})), ErrorKind::kInvalidInput,
                 "/materials/0/emissiveFactor/2");
  expect_refused(patch(edit("replace", "/materials/0/normalTexture/index", 2)), ErrorKind::kNotFound,
                 "/materials/0/normalTexture/index");
  expect_refused(patch(edit("add", "/materials/0/extensions/KHR_materials_dispersion/dispersion", 1)),
                 ErrorKind::kNotFound, "/materials/0/extensions/KHR_materials_dispersion/dispersion");
}

TEST(MaterialEdits, SetAGroupAtOnce) {
  Scene scene = make_edit_scene();
  scene.materials[0].roughness_factor = 0.5f;
  scene.materials[0].base_color_texture.texture = 1;
  apply_or_fail(scene, patch(edit("replace", "/materials/0/pbrMetallicRoughness", {{"metallicFactor", 0}})));
  EXPECT_EQ(scene.materials[0].metallic_factor, 0.0f);
  EXPECT_EQ(scene.materials[0].roughness_factor, 1.0f);
  EXPECT_EQ(scene.materials[0].base_color_texture.texture, -1);
  EXPECT_EQ(scene.materials[0].name, "red");
  apply_or_fail(scene, patch(removal("/materials/0/pbrMetallicRoughness")));
  EXPECT_EQ(scene.materials[0].metallic_factor, 1.0f);
}

TEST(MaterialEdits, ThoseThatComeAndGoMoveTheirReferences) {
  const Scene original = make_edit_scene();
  Scene scene = original;
  apply_or_fail(scene, patch(removal("/materials/red")));
  EXPECT_EQ(scene.meshes[0]->primitives[0].material, -1);
  EXPECT_EQ(scene.meshes[1]->primitives[0].material, 1);
  EXPECT_EQ(original.meshes[1]->primitives[0].material, 2) << "shared meshes belong to others too";
  apply_or_fail(scene,
                patch(edit("add", "/materials/0", {{"name", "first"}}), edit("add", "/materials/-", {{"name", "last"}}),
                      edit("replace", "/meshes/0/primitives/0/material", "last")));
  EXPECT_EQ(scene.meshes[1]->primitives[0].material, 2);
  EXPECT_EQ(scene.meshes[0]->primitives[0].material, 3);
  apply_or_fail(scene, patch(removal("/meshes/0/primitives/0/material")));
  EXPECT_EQ(scene.meshes[0]->primitives[0].material, -1);
}

TEST(MaterialEdits, MeshesThatAreNotConcernedStayShared) {
  const Scene original = make_edit_scene();
  Scene scene = original;
  apply_or_fail(scene, patch(removal("/materials/green")));
  EXPECT_EQ(scene.meshes[0], original.meshes[0]);
  EXPECT_NE(scene.meshes[1], original.meshes[1]);
  EXPECT_EQ(scene.meshes[1]->primitives[0].material, 1);
}

TEST(LightEdits, SetEveryProperty) {
  Scene scene = make_edit_scene();
  const Json whole{{"name", "lamp"},   {"type", "spot"}, {"color", {1, 0.5, 0.25}},
                   {"intensity", 100}, {"range", 20},    {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}};
  apply_or_fail(scene, patch(edit("add", kLights + "-", whole), edit("test", kLights + "lamp", whole),
                             edit("replace", kLights + "lamp/color/1", 0.75)));
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[2].kind, LightKind::kSpot);
  EXPECT_EQ(scene.lights[2].color, glm::vec3(1, 0.75f, 0.25f));
  EXPECT_EQ(scene.lights[2].range_m, 20.0f);
  apply_or_fail(scene, patch(removal(kLights + "2/range"), removal(kLights + "2/spot")));
  EXPECT_EQ(scene.lights[2].range_m, 0.0f);
  EXPECT_EQ(scene.lights[2].inner_cone_angle, 0.0f);
}

TEST(LightEdits, RefuseWhatIsNoLight) {
  expect_refused(patch(edit("replace", kLights + "0/intensity", -1)), ErrorKind::kInvalidInput,
                 kLights + "0/intensity");
  expect_refused(patch(edit("replace", kLights + "0/color", {1, -1, 1})), ErrorKind::kInvalidInput,
                 kLights + "0/color/1");
  expect_refused(patch(edit("replace", kLights + "0/type", "area")), ErrorKind::kInvalidInput, kLights + "0/type");
  expect_refused(patch(edit("replace", kLights + "0/range", 0)), ErrorKind::kInvalidInput, kLights + "0/range");
  expect_refused(patch(edit("replace", kLights + "1/spot/innerConeAngle", 0.8)), ErrorKind::kInvalidInput,
                 kLights + "1/spot/innerConeAngle");
  expect_refused(patch(edit("replace", kLights + "1/spot/outerConeAngle", 1.6)), ErrorKind::kInvalidInput,
                 kLights + "1/spot/outerConeAngle");
  expect_refused(patch(edit("replace", kLights + "1/spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.3}})),
                 ErrorKind::kInvalidInput, kLights + "1/spot");
}

TEST(LightEdits, ThoseThatComeAndGoMoveTheirReferences) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(removal(kLights + "sun")));
  EXPECT_EQ(scene.nodes[3].light, 0);
  EXPECT_EQ(scene.animations[0].light_channels[0].light, 0);
  apply_or_fail(scene, patch(edit("add", kLights + "0", {{"type", "point"}})));
  EXPECT_EQ(scene.nodes[3].light, 1);
  EXPECT_EQ(scene.animations[0].light_channels[0].light, 1);
  apply_or_fail(scene, patch(removal(kLights + "spot")));
  EXPECT_EQ(scene.nodes[3].light, -1);
  EXPECT_TRUE(scene.animations[0].light_channels.empty());
  EXPECT_EQ(scene.animations[0].duration_s, 1.0f);
}

TEST(CameraEdits, SetAndRefuse) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("replace", "/cameras/0/perspective", {{"yfov", 1}, {"znear", 0.5}, {"zfar", 100}}),
                             edit("replace", "/cameras/0/perspective/aspectRatio", 1.5)));
  EXPECT_EQ(describe_scene(scene)["cameras"][0],
            (Json{{"name", "front"},
                  {"type", "perspective"},
                  {"perspective", {{"yfov", 1.0}, {"znear", 0.5}, {"zfar", 100.0}, {"aspectRatio", 1.5}}}}));
  apply_or_fail(scene, patch(edit("replace", "/cameras/0",
                                  {{"type", "orthographic"},
                                   {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 10}}}})));
  EXPECT_FALSE(scene.cameras[0].perspective);
  EXPECT_EQ(scene.cameras[0].ymag, 3.0f);
  expect_refused(patch(edit("test", "/cameras/0/perspective/yfov", 1)), ErrorKind::kNotFound,
                 "/cameras/0/perspective/yfov", scene);
  expect_refused(patch(edit("replace", "/cameras/0/perspective/yfov", 0)), ErrorKind::kInvalidInput,
                 "/cameras/0/perspective/yfov");
  expect_refused(patch(edit("replace", "/cameras/0/perspective/zfar", 0.01)), ErrorKind::kInvalidInput,
                 "/cameras/0/perspective/zfar");
  apply_or_fail(scene, patch(edit("add", "/cameras/0", {{"type", "perspective"}}), edit("test", "/nodes/5/camera", 1),
                             removal("/cameras/1")));
  EXPECT_EQ(scene.nodes[5].camera, -1);
}

TEST(EnvironmentEdits, SetAndRefuse) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene,
                patch(edit("replace", kEnvironment + "/zenith", {100, 200, 400}),
                      edit("replace", kEnvironment + "/strength", 2), edit("replace", kEnvironment + "/rotation", -1)));
  EXPECT_EQ(scene.environment.zenith_radiance, glm::vec3(100, 200, 400));
  EXPECT_EQ(scene.environment.strength, 2.0f);
  apply_or_fail(scene, patch(edit("replace", kEnvironment, {{"ground", {1, 1, 1}}})));
  EXPECT_EQ(scene.environment.zenith_radiance, glm::vec3(0));
  EXPECT_EQ(scene.environment.ground_radiance, glm::vec3(1));
  apply_or_fail(scene, patch(removal(kEnvironment)));
  EXPECT_EQ(scene.environment.ground_radiance, glm::vec3(0));
  expect_refused(patch(edit("replace", kEnvironment + "/horizon", {1, -1, 1})), ErrorKind::kInvalidInput,
                 kEnvironment + "/horizon/1");
  expect_refused(patch(edit("replace", kEnvironment + "/image", "sky.exr")), ErrorKind::kNotFound,
                 kEnvironment + "/image");
}

TEST(Description, IsGltf) {
  const Json model = describe_scene(make_edit_scene());
  EXPECT_EQ(model["scenes"], Json::parse(R"([{"nodes":[0,3,4,5]}])"));
  EXPECT_EQ(model["nodes"][0], (Json{{"name", "body"}, {"mesh", 0}, {"children", {1}}}));
  EXPECT_EQ(model["nodes"][3], Json::parse(R"({"name":"lamp","extensions":{"KHR_lights_punctual":{"light":1}}})"));
  EXPECT_EQ(model["meshes"][1], Json::parse(R"({"name":"blue triangle","primitives":[{"material":2}]})"));
  EXPECT_EQ(model["extensions"]["KHR_lights_punctual"]["lights"][0], (Json{{"name", "sun"}, {"type", "directional"}}));
  EXPECT_EQ(model["animations"][0]["channels"][1]["target"], (Json{{"node", 3}, {"path", "translation"}}));
  EXPECT_EQ(model["animations"][0]["channels"][2]["target"]["extensions"]["KHR_animation_pointer"]["pointer"],
            "/extensions/KHR_lights_punctual/lights/1/intensity");
}

TEST(Description, NumbersAreAsShortAsTheyCanBe) {
  Scene scene = make_edit_scene();
  scene.nodes[0].local.translation = {0.1f, 1e-20f, 16777216.0f};
  EXPECT_EQ(describe_scene(scene)["nodes"][0]["translation"].dump(), "[0.1,1e-20,16777216.0]");
}

TEST(Description, WhatItWritesCanBeSet) {
  for (const std::string& name : builtin_scene_names()) {
    SCOPED_TRACE(name);
    const Result<Scene> loaded = builtin_scene(name);
    ASSERT_TRUE(loaded.ok());
    Scene scene = *loaded;
    const Json model = describe_scene(scene);
    Json all = Json::array();
    for (const char* kind : {"materials", "cameras"})
      for (std::size_t i = 0; i < model[kind].size(); ++i)
        all.push_back(edit("replace", '/' + std::string(kind) + '/' + std::to_string(i), model[kind][i]));
    const Json& lights = model["extensions"]["KHR_lights_punctual"]["lights"];
    for (std::size_t i = 0; i < lights.size(); ++i)
      all.push_back(edit("replace", kLights + std::to_string(i), lights[i]));
    for (std::size_t i = 0; i < model["nodes"].size(); ++i)
      for (const char* part : {"translation", "rotation", "scale", "matrix", "mesh", "children"})
        if (model["nodes"][i].contains(part))
          all.push_back(edit("replace", "/nodes/" + std::to_string(i) + '/' + part, model["nodes"][i][part]));
    all.push_back(edit("replace", kEnvironment, model["extensions"]["LIGHTWELL_environment"]));
    apply_or_fail(scene, all);
    Json again = describe_scene(scene);
    again["animations"] = model["animations"];  // what was set is animated no more
    EXPECT_EQ(again, model);
  }
}

}  // namespace
}  // namespace lightwell
