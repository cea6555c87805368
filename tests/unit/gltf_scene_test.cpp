// Nodes, scenes, lights and cameras from glTF, against values worked out by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/gltf_loaded.h"

namespace lightwell {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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
