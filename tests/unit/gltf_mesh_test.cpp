// Meshes from glTF: accessors of every kind, triangles, normals, tangents, colours, joints and morph targets, against
// values worked out by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/gltf_loaded.h"

namespace lightwell {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr float kTolerance = 1e-5f;

/// The first primitive of the first mesh.
Primitive primitive_of(const GltfBuilder& builder) {
  const Scene scene = loaded(builder);
  if (scene.meshes.empty() || scene.meshes[0]->primitives.empty()) {
    ADD_FAILURE() << "there is no primitive";
    return {};
  }
  return scene.meshes[0]->primitives[0];
}

void expect_near(const glm::vec3& actual, const glm::vec3& expected) {
  EXPECT_NEAR(actual.x, expected.x, kTolerance);
  EXPECT_NEAR(actual.y, expected.y, kTolerance);
  EXPECT_NEAR(actual.z, expected.z, kTolerance);
}

TEST(GltfMesh, ATriangleWithNothingButPositions) {
  const Primitive primitive = primitive_of(GltfBuilder::triangle());
  EXPECT_THAT(primitive.positions, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(primitive.indices, ElementsAre(0, 1, 2));
  EXPECT_EQ(primitive.bounds_min, glm::vec3(0, 0, 0));
  EXPECT_EQ(primitive.bounds_max, glm::vec3(1, 1, 0));
  EXPECT_EQ(primitive.material, -1);
  for (const glm::vec3& normal : primitive.normals) expect_near(normal, {0, 0, 1});
  ASSERT_EQ(primitive.tangents.size(), 3u);
  for (const glm::vec4& tangent : primitive.tangents) {
    EXPECT_NEAR(glm::dot(glm::vec3(tangent), glm::vec3(0, 0, 1)), 0.0f, kTolerance);
    EXPECT_NEAR(glm::length(glm::vec3(tangent)), 1.0f, kTolerance);
  }
}

template <class T>
class GltfIndices : public testing::Test {};
using IndexTypes = testing::Types<std::uint8_t, std::uint16_t, std::uint32_t>;
TYPED_TEST_SUITE(GltfIndices, IndexTypes);

TYPED_TEST(GltfIndices, OfEveryWidth) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["indices"] = builder.add_accessor<TypeParam>({2, 0, 1}, "SCALAR");
  builder.primitive()["attributes"]["NORMAL"] = builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  EXPECT_THAT(primitive_of(builder).indices, ElementsAre(2, 0, 1));
}

/// A fan or strip over five vertices, with normals so that vertices stay shared.
GltfBuilder five_vertices(int mode) {
  GltfBuilder builder;
  const int positions = builder.add_accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0}, "VEC3");
  const int normals = builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  builder.add_mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"mode", mode}});
  return builder;
}

TEST(GltfMesh, StripKeepsTheWinding) {
  EXPECT_THAT(primitive_of(five_vertices(5)).indices, ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
}

TEST(GltfMesh, FanTurnsAroundItsFirstVertex) {
  EXPECT_THAT(primitive_of(five_vertices(6)).indices, ElementsAre(1, 2, 0, 2, 3, 0, 3, 4, 0));
}

TEST(GltfMesh, StripsLeaveOutWhatOnlyConnects) {
  GltfBuilder builder = five_vertices(5);
  builder.primitive()["indices"] = builder.add_accessor<std::uint8_t>({0, 1, 2, 2, 2, 3, 4}, "SCALAR");
  EXPECT_THAT(primitive_of(builder).indices, ElementsAre(0, 1, 2, 2, 3, 4));
}

TEST(GltfMesh, ListsDropWhatIsNoWholeTriangle) {
  const GltfBuilder builder = five_vertices(4);
  EXPECT_THAT(primitive_of(builder).indices, ElementsAre(0, 1, 2));
  EXPECT_THAT(loaded(builder).warnings, Contains(HasSubstr("whole triangles")));
}

TEST(GltfMesh, PointsAndLinesAreLeftOut) {
  for (int mode = 0; mode < 4; ++mode) {
    GltfBuilder builder = GltfBuilder::triangle();
    json lines = builder.primitive();
    lines["mode"] = mode;
    builder.root["meshes"][0]["primitives"].push_back(lines);
    const Scene scene = loaded(builder);
    EXPECT_EQ(scene.meshes[0]->primitives.size(), 1u);
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("meshes/0/primitives/1: points and lines")));
  }
}

TEST(GltfMesh, PrimitivesWithoutTrianglesAreLeftOut) {
  GltfBuilder builder = GltfBuilder::triangle();
  json empty = builder.primitive();
  empty["indices"] = builder.add("accessors", {{"componentType", 5121}, {"count", 0}, {"type", "SCALAR"}});
  builder.root["meshes"][0]["primitives"].push_back(empty);
  builder.root["meshes"][0]["primitives"].push_back({{"attributes", json::object()}});
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.meshes[0]->primitives.size(), 1u);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("no triangle"), HasSubstr("no positions")));
}

TEST(GltfMesh, NoTriangleAtAllIsRefused) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["mode"] = 0;
  const Result<Scene> scene = builder.load();
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(scene.error().where, "meshes");
}

TEST(GltfMesh, NoMeshAtAllIsAWarning) {
  const Scene scene = loaded(GltfBuilder());
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("no mesh")));
}

TEST(GltfAccessor, StrideAndOffset) {
  GltfBuilder builder = GltfBuilder::triangle();
  // Two floats in front, then position and two floats more, three times.
  const std::vector<float> data{9, 9, 0, 0, 0, 9, 9, 2, 0, 0, 9, 9, 0, 2, 0};
  builder.root["bufferViews"][0] = {};
  const int view = builder.add_view(data, 20);
  builder.root["bufferViews"].erase(0);
  builder.root["accessors"][0]["bufferView"] = view - 1;
  builder.root["accessors"][0]["byteOffset"] = 8;
  EXPECT_THAT(primitive_of(builder).positions, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(2, 0, 0), glm::vec3(0, 2, 0)));
}

TEST(GltfAccessor, NormalisedIntegers) {
  GltfBuilder builder = GltfBuilder::triangle();
  json& attributes = builder.primitive()["attributes"];
  attributes["TEXCOORD_0"] = builder.add_accessor<std::uint8_t>({0, 255, 51, 0, 0, 0}, "VEC2", true);
  attributes["TEXCOORD_1"] = builder.add_accessor<std::uint16_t>({65535, 13107, 0, 0, 0, 0}, "VEC2", true);
  const Primitive primitive = primitive_of(builder);
  EXPECT_THAT(primitive.uv0, ElementsAre(glm::vec2(0, 1), glm::vec2(0.2f, 0), glm::vec2(0, 0)));
  EXPECT_THAT(primitive.uv1, ElementsAre(glm::vec2(1, 0.2f), glm::vec2(0, 0), glm::vec2(0, 0)));
}

TEST(GltfAccessor, QuantisedPositionsAndNormals) {
  GltfBuilder builder;
  builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int positions = builder.add_accessor<std::int16_t>({0, 0, 0, 300, 0, 0, 0, -300, 0}, "VEC3");
  // -128 and -127 are both -1.
  const int normals = builder.add_accessor<std::int8_t>({0, 0, -128, 0, 0, -127, 127, 0, 0}, "VEC3", true);
  builder.add_mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
  const Primitive primitive = primitive_of(builder);
  EXPECT_THAT(primitive.positions, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(300, 0, 0), glm::vec3(0, -300, 0)));
  EXPECT_THAT(primitive.normals, ElementsAre(glm::vec3(0, 0, -1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0)));
}

TEST(GltfAccessor, UnnormalisedIntegersAreTakenAsTheyAre) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["attributes"]["TEXCOORD_0"] = builder.add_accessor<std::uint8_t>({1, 2, 3, 4, 5, 6}, "VEC2");
  EXPECT_EQ(primitive_of(builder).uv0[1], glm::vec2(3, 4));
}

json sparse(int count, int index_view, int index_type, int value_view) {
  return {{"count", count},
          {"indices", {{"bufferView", index_view}, {"componentType", index_type}}},
          {"values", {{"bufferView", value_view}}}};
}

TEST(GltfAccessor, SparseOverABase) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int indices = builder.add_view<std::uint16_t>({1, 2});
  const int values = builder.add_view<float>({5, 0, 0, 0, 7, 0});
  builder.root["accessors"][0]["sparse"] = sparse(2, indices, 5123, values);
  EXPECT_THAT(primitive_of(builder).positions, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(5, 0, 0), glm::vec3(0, 7, 0)));
}

TEST(GltfAccessor, SparseOverNothing) {
  GltfBuilder builder;
  const int indices = builder.add_view<std::uint8_t>({2, 1});
  const int values = builder.add_view<float>({0, 1, 0, 1, 0, 0});
  const int positions = builder.add(
      "accessors",
      {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse(2, indices, 5121, values)}});
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}});
  EXPECT_THAT(primitive_of(builder).positions, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
}

TEST(GltfAccessor, SparseIndicesOfATriangleOverNothing) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["attributes"]["NORMAL"] = builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int indices = builder.add_view<std::uint32_t>({1, 2});
  const int values = builder.add_view<std::uint16_t>({2, 1});
  builder.primitive()["indices"] = builder.add(
      "accessors",
      {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}, {"sparse", sparse(2, indices, 5125, values)}});
  EXPECT_THAT(primitive_of(builder).indices, ElementsAre(0, 2, 1));
}

TEST(GltfMesh, ColoursOfThreeAndFourComponents) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["attributes"]["COLOR_0"] =
      builder.add_accessor<std::uint8_t>({255, 0, 51, 0, 0, 0, 0, 0, 0}, "VEC3", true);
  EXPECT_EQ(primitive_of(builder).colors[0], glm::vec4(1, 0, 0.2f, 1));
  builder.primitive()["attributes"]["COLOR_0"] =
      builder.add_accessor<float>({1, 2, 3, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  EXPECT_EQ(primitive_of(builder).colors[0], glm::vec4(1, 2, 3, 0.5f));
}

TEST(GltfMesh, FlatNormalsTakeSharedVerticesApart) {
  // Two triangles at a right angle over a shared edge on the y axis.
  GltfBuilder builder;
  const int positions = builder.add_accessor<float>({0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, -1}, "VEC3");
  const int uvs = builder.add_accessor<float>({0, 0, 0, 1, 1, 0, 1, 1}, "VEC2");
  builder.add_mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
                    {"indices", builder.add_accessor<std::uint8_t>({0, 1, 2, 0, 3, 1}, "SCALAR")}});
  const Primitive primitive = primitive_of(builder);
  ASSERT_EQ(primitive.positions.size(), 6u);
  EXPECT_THAT(primitive.indices, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(primitive.positions[4], glm::vec3(0, 0, -1));
  EXPECT_EQ(primitive.uv0[4], glm::vec2(1, 1));
  for (int i = 0; i < 3; ++i) expect_near(primitive.normals[i], {0, 0, 1});
  for (int i = 3; i < 6; ++i) expect_near(primitive.normals[i], {1, 0, 0});
}

TEST(GltfMesh, NormalsWithoutDirectionAreMadeAnew) {
  GltfBuilder builder = GltfBuilder::triangle();
  const float nan = std::nanf("");
  builder.primitive()["attributes"]["NORMAL"] = builder.add_accessor<float>({0, 0, 0, nan, 0, 0, 0, 3, 0}, "VEC3");
  const Primitive primitive = primitive_of(builder);
  expect_near(primitive.normals[0], {0, 0, 1});
  expect_near(primitive.normals[1], {0, 0, 1});
  expect_near(primitive.normals[2], {0, 1, 0});  // only its length was wrong
  EXPECT_THAT(loaded(builder).warnings, ElementsAre(HasSubstr("made anew")));
}

TEST(GltfMesh, DegenerateTrianglesGetSomeNormal) {
  GltfBuilder builder;
  builder.add_mesh({{"attributes", {{"POSITION", builder.add_accessor<float>({1, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC3")}}}});
  for (const glm::vec3& normal : primitive_of(builder).normals) EXPECT_NEAR(glm::length(normal), 1.0f, kTolerance);
}

/// A triangle with normals, texture coordinates as images lie (v downwards) and a normal texture.
GltfBuilder normal_mapped() {
  GltfBuilder builder = GltfBuilder::triangle();
  json& attributes = builder.primitive()["attributes"];
  attributes["NORMAL"] = builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  attributes["TEXCOORD_0"] = builder.add_accessor<float>({0, 1, 1, 1, 0, 0}, "VEC2");
  builder.primitive()["material"] = builder.add("materials", {{"normalTexture", {{"index", builder.add_texture()}}}});
  return builder;
}

TEST(GltfMesh, TangentsFollowTheNormalTexture) {
  for (const glm::vec4& tangent : primitive_of(normal_mapped()).tangents) {
    expect_near(glm::vec3(tangent), {1, 0, 0});
    EXPECT_EQ(tangent.w, 1.0f);
  }
}

TEST(GltfMesh, TangentsFollowTheTextureTransform) {
  // A quarter turn of the texture coordinates, counter-clockwise as one sees the image: u' = v, v' = -u.
  GltfBuilder builder = normal_mapped();
  builder.root["extensionsUsed"] = {"KHR_texture_transform"};
  builder.root["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["rotation"] = std::acos(0.0);
  for (const glm::vec4& tangent : primitive_of(builder).tangents) {
    expect_near(glm::vec3(tangent), {0, -1, 0});
    EXPECT_EQ(tangent.w, 1.0f);
  }
}

TEST(GltfMesh, GivenTangentsAreKept) {
  GltfBuilder builder = normal_mapped();
  builder.primitive()["attributes"]["TANGENT"] =
      builder.add_accessor<float>({0, 2, 0, -1, 0, 0, 0, 1, 0, 0, 1, 1}, "VEC4");
  const Primitive primitive = primitive_of(builder);
  EXPECT_EQ(primitive.tangents[0], glm::vec4(0, 1, 0, -1));
  // Neither nothing nor the normal's own direction is a tangent.
  for (int i = 1; i < 3; ++i) {
    EXPECT_NEAR(primitive.tangents[i].z, 0.0f, kTolerance);
    EXPECT_NEAR(glm::length(glm::vec3(primitive.tangents[i])), 1.0f, kTolerance);
  }
}

GltfBuilder skinned() {
  GltfBuilder builder = GltfBuilder::triangle();
  json& attributes = builder.primitive()["attributes"];
  attributes["JOINTS_0"] = builder.add_accessor<std::uint8_t>({0, 1, 9, 9, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  attributes["WEIGHTS_0"] = builder.add_accessor<float>({1, 3, 0, -1, 2, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  builder.add("nodes", {{"name", "joint 0"}});
  builder.add("nodes", {{"name", "joint 1"}});
  builder.root["nodes"][0]["skin"] = builder.add("skins", {{"joints", {1, 2}}});
  return builder;
}

TEST(GltfSkin, WeightsSumToOne) {
  const Primitive primitive = primitive_of(skinned());
  EXPECT_EQ(primitive.weights[0], glm::vec4(0.75f, 0.25f, 0, 0));  // the strongest first
  EXPECT_EQ(primitive.joints[0], glm::uvec4(1, 0, 0, 0));          // joint 9 has no weight and is of no account
  EXPECT_EQ(primitive.weights[1], glm::vec4(1, 0, 0, 0));
  EXPECT_EQ(primitive.joints[1], glm::uvec4(1, 0, 0, 0));
  EXPECT_EQ(primitive.weights[2], glm::vec4(1, 0, 0, 0));  // had no weight at all
  EXPECT_THAT(loaded(skinned()).warnings, ElementsAre(HasSubstr("without any weight")));
}

TEST(GltfSkin, TheStrongestFourOfEight) {
  GltfBuilder builder = skinned();
  json& attributes = builder.primitive()["attributes"];
  attributes["JOINTS_1"] = builder.add_accessor<std::uint16_t>({0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0}, "VEC4");
  attributes["WEIGHTS_1"] =
      builder.add_accessor<std::uint8_t>({0, 0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 0}, "VEC4", true);
  const Primitive primitive = primitive_of(builder);
  EXPECT_EQ(primitive.weights[1], glm::vec4(0.4f, 0.2f, 0.2f, 0.2f));
  EXPECT_EQ(primitive.joints[1], glm::uvec4(1, 0, 1, 0));
  EXPECT_THAT(loaded(builder).warnings, Contains(HasSubstr("strongest four")));
}

TEST(GltfSkin, MatricesAreIdentityWhereNoneAreGiven) {
  const Scene scene = loaded(skinned());
  EXPECT_THAT(scene.skins[0].joints, ElementsAre(1, 2));
  EXPECT_THAT(scene.skins[0].joint_from_mesh, ElementsAre(glm::mat4(1.0f), glm::mat4(1.0f)));
  EXPECT_EQ(scene.nodes[0].skin, 0);
}

TEST(GltfSkin, GivenMatrices) {
  GltfBuilder builder = skinned();
  std::vector<float> matrices(3 * 16, 0.0f);  // one more than joints, as glTF allows
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t d = 0; d < 4; ++d) matrices[16 * i + 5 * d] = 1.0f;
  matrices[16 + 12] = 7.0f;  // the second moves along x
  builder.root["skins"][0]["inverseBindMatrices"] = builder.add_accessor<float>(matrices, "MAT4");
  const Scene scene = loaded(builder);
  ASSERT_EQ(scene.skins[0].joint_from_mesh.size(), 2u);
  EXPECT_EQ(scene.skins[0].joint_from_mesh[1][3], glm::vec4(7, 0, 0, 1));
}

TEST(GltfSkin, ASkinWithNothingToDeformIsIgnored) {
  GltfBuilder builder = skinned();
  builder.primitive()["attributes"].erase("JOINTS_0");
  builder.primitive()["attributes"].erase("WEIGHTS_0");
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.nodes[0].skin, -1);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("skin is ignored")));
}

TEST(GltfMorph, TargetsAndDefaultWeights) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["attributes"]["NORMAL"] = builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int up = builder.add_accessor<float>({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3");
  const int index = builder.add_view<std::uint8_t>({1});
  const int value = builder.add_view<float>({0, 5, 0});
  const int one_vertex =
      builder.add("accessors",
                  {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse(1, index, 5121, value)}});
  builder.primitive()["targets"] = {{{"POSITION", up}, {"NORMAL", up}}, {{"POSITION", one_vertex}}};
  builder.root["meshes"][0]["weights"] = {0.25, 0.5};
  const Scene scene = loaded(builder);
  EXPECT_THAT(scene.meshes[0]->weights, ElementsAre(0.25f, 0.5f));
  const Primitive& primitive = scene.meshes[0]->primitives[0];
  ASSERT_EQ(primitive.morph_targets.size(), 2u);
  EXPECT_EQ(primitive.morph_targets[0].positions[2], glm::vec3(0, 0, 3));
  EXPECT_EQ(primitive.morph_targets[0].normals[1], glm::vec3(0, 0, 2));
  EXPECT_THAT(primitive.morph_targets[1].positions, ElementsAre(glm::vec3(0), glm::vec3(0, 5, 0), glm::vec3(0)));
  EXPECT_THAT(primitive.morph_targets[1].normals, IsEmpty());
}

TEST(GltfMorph, FlatNormalsMorphToo) {
  // The target turns the triangle from the xy plane into the xz plane: the normal from +z to -y.
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["targets"] = {{{"POSITION", builder.add_accessor<float>({0, 0, 0, 0, 0, 0, 0, -1, 1}, "VEC3")}}};
  const Primitive primitive = primitive_of(builder);
  for (int i = 0; i < 3; ++i) expect_near(primitive.normals[i] + primitive.morph_targets[0].normals[i], {0, -1, 0});
  EXPECT_THAT(loaded(builder).meshes[0]->weights, ElementsAre(0.0f));
}

TEST(GltfMesh, UnknownAttributesAreNamedOnce) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int uvs = builder.add_accessor<float>({0, 0, 0, 0, 0, 0}, "VEC2");
  builder.primitive()["attributes"]["TEXCOORD_2"] = uvs;
  builder.primitive()["attributes"]["_OWN"] = uvs;
  builder.root["meshes"][0]["primitives"].push_back(builder.primitive());
  EXPECT_THAT(loaded(builder).warnings, ElementsAre(HasSubstr("'TEXCOORD_2' is ignored")));
}

}  // namespace
}  // namespace lightwell
