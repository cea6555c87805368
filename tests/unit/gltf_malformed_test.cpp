// Broken and hostile glTF: an error that names the object, whatever is wrong; never a crash, never an exception.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <random>

#include "tests/unit/rich_gltf.h"

namespace lightwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(GltfMalformed, TheFileToBreakIsWhole) {
  const Result<Scene> scene = rich_gltf().load();
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  EXPECT_THAT(scene->warnings, testing::IsEmpty());
}

struct Break {
  std::string name;
  std::function<void(json&)> apply;  // to the document of rich_gltf()
  std::string where;                 // the error's
  std::string what;                  // part of it
  ErrorKind kind = ErrorKind::kInvalidInput;
};

void PrintTo(const Break& broken, std::ostream* out) {
  *out << broken.name;
}

class GltfBroken : public testing::TestWithParam<Break> {};

TEST_P(GltfBroken, IsRefusedByName) {
  GltfBuilder builder = rich_gltf();
  GetParam().apply(builder.root);
  const Result<Scene> scene = builder.load();
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().where, GetParam().where);
  EXPECT_THAT(scene.error().what, HasSubstr(GetParam().what));
  EXPECT_EQ(scene.error().kind, GetParam().kind);
}

const std::string kPrimitive = "meshes/0/primitives/0";

std::vector<Break> broken_types() {
  return {
      {"MeshIsText", [](json& g) { g["nodes"][0]["mesh"] = "zero"; }, "nodes/0/mesh", "whole number"},
      {"MeshIsAFraction", [](json& g) { g["nodes"][0]["mesh"] = 0.5; }, "nodes/0/mesh", "whole number"},
      {"MeshIsNegative", [](json& g) { g["nodes"][0]["mesh"] = -1; }, "nodes/0/mesh", "0 or more"},
      {"MeshWrapsAround", [](json& g) { g["nodes"][0]["mesh"] = 4294967296; }, "nodes/0/mesh", "more than",
       ErrorKind::kTooLarge},
      {"NodesIsAnObject", [](json& g) { g["nodes"] = json::object(); }, "nodes", "an array"},
      {"NodeIsANumber", [](json& g) { g["nodes"][0] = 7; }, "nodes/0", "an object"},
      {"TranslationIsShort",
       [](json& g) {
         g["nodes"][1]["translation"] = {1, 2};
       },
       "nodes/1/translation", "3 numbers"},
      {"TranslationIsText",
       [](json& g) {
         g["nodes"][1]["translation"] = {1, 2, "x"};
       },
       "nodes/1/translation/2", "a number"},
      {"NameIsANumber", [](json& g) { g["nodes"][1]["name"] = 1; }, "nodes/1/name", "a string"},
      {"DoubleSidedIsText", [](json& g) { g["materials"][0]["doubleSided"] = "no"; }, "materials/0/doubleSided",
       "true"},
      {"TextureIsAnIndex", [](json& g) { g["materials"][0]["normalTexture"] = 0; }, "materials/0/normalTexture",
       "an object"},
      {"IorIsText", [](json& g) { g["materials"][0]["extensions"]["KHR_materials_ior"]["ior"] = "high"; },
       "materials/0/extensions/KHR_materials_ior/ior", "a number"},
      {"AttributeIsText", [](json& g) { g["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = "0"; },
       kPrimitive + "/attributes/POSITION", "whole number"},
      {"NoAttributes", [](json& g) { g["meshes"][0]["primitives"][0].erase("attributes"); }, kPrimitive,
       "no 'attributes'"},
      {"NoCount", [](json& g) { g["accessors"][0].erase("count"); }, "accessors/0", "no 'count'"},
      {"NoAsset", [](json& g) { g.erase("asset"); }, "", "no 'asset'"},
      {"OldVersion", [](json& g) { g["asset"]["version"] = "1.0"; }, "asset/version", "'1.0'", ErrorKind::kUnsupported},
      {"NewVersion", [](json& g) { g["asset"]["minVersion"] = "2.1"; }, "asset/minVersion", "'2.1'",
       ErrorKind::kUnsupported},
  };
}

std::vector<Break> broken_references() {
  return {
      {"NoSuchMesh", [](json& g) { g["nodes"][0]["mesh"] = 5; }, "nodes/0/mesh", "no 5"},
      {"NoSuchSkin", [](json& g) { g["nodes"][0]["skin"] = 5; }, "nodes/0/skin", "no 5"},
      {"NoSuchCamera", [](json& g) { g["nodes"][1]["camera"] = 5; }, "nodes/1/camera", "no 5"},
      {"NoSuchLight", [](json& g) { g["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 5; },
       "nodes/2/extensions/KHR_lights_punctual/light", "no 5"},
      {"NoSuchChild", [](json& g) { g["nodes"][2]["children"] = {5}; }, "nodes/2/children", "no 5"},
      {"NoSuchScene", [](json& g) { g["scene"] = 5; }, "scene", "no 5"},
      {"NoSuchRoot", [](json& g) { g["scenes"][0]["nodes"] = {5}; }, "scenes/0/nodes", "no 5"},
      {"NoSuchMaterial", [](json& g) { g["meshes"][0]["primitives"][0]["material"] = 5; }, kPrimitive + "/material",
       "no 5"},
      {"NoSuchAccessor", [](json& g) { g["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 99; },
       kPrimitive + "/attributes/NORMAL", "no 99"},
      {"NoSuchTexture", [](json& g) { g["materials"][0]["normalTexture"]["index"] = 5; },
       "materials/0/normalTexture/index", "no 5"},
      {"NoSuchImage", [](json& g) { g["textures"][0]["source"] = 5; }, "textures/0/source", "no 5"},
      {"NoSuchSampler", [](json& g) { g["textures"][0]["sampler"] = 5; }, "textures/0/sampler", "no 5"},
      {"NoSuchBufferView", [](json& g) { g["accessors"][0]["bufferView"] = 99; }, "accessors/0/bufferView", "no 99"},
      {"NoSuchBuffer", [](json& g) { g["bufferViews"][0]["buffer"] = 5; }, "bufferViews/0/buffer", "no 5"},
      {"NoSuchImageView", [](json& g) { g["images"][0]["bufferView"] = 99; }, "images/0/bufferView", "no 99"},
      {"NoSuchJoint",
       [](json& g) {
         g["skins"][0]["joints"] = {1, 5};
       },
       "skins/0/joints", "no 5"},
      {"NoSuchAnimatedNode", [](json& g) { g["animations"][0]["channels"][0]["target"]["node"] = 5; },
       "animations/0/channels/0/target/node", "no 5"},
      {"NoSuchAnimationSampler", [](json& g) { g["animations"][0]["channels"][0]["sampler"] = 5; },
       "animations/0/channels/0/sampler", "no 5"},
      {"TwoParents", [](json& g) { g["nodes"][3]["children"] = {1}; }, "nodes/3/children", "already a child of node 2"},
      {"OwnParent", [](json& g) { g["nodes"][0]["children"] = {0}; }, "nodes/0", "its own ancestor"},
      {"Circle",
       [](json& g) {
         g["nodes"][1]["children"] = {0};
         g["nodes"][0]["children"] = {2};
       },
       "nodes/0", "its own ancestor"},
      {"RootIsAChild",
       [](json& g) {
         g["scenes"][0]["nodes"] = {0, 1};
       },
       "scenes/0/nodes", "not a root"},
      {"RootTwice",
       [](json& g) {
         g["scenes"][0]["nodes"] = {0, 0};
       },
       "scenes/0/nodes", "twice"},
  };
}

std::vector<Break> broken_data() {
  return {
      {"FourBillionPositions", [](json& g) { g["accessors"][0]["count"] = 4294967295; }, "accessors/0/count",
       "more than", ErrorKind::kTooLarge},
      {"TwoBillionPositions", [](json& g) { g["accessors"][0]["count"] = 2147483647; }, kPrimitive, "vertices",
       ErrorKind::kTooLarge},
      {"TwoBillionNothings",
       [](json& g) {
         g["accessors"][0]["count"] = 2147483647;
         g["accessors"][0].erase("bufferView");
       },
       kPrimitive, "vertices", ErrorKind::kTooLarge},
      {"MorePositionsThanBytes",
       [](json& g) {
         g["accessors"][0]["count"] = 4;
         g["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 0}};
       },
       "accessors/0", "4 elements end at byte 48 of a buffer view of 36"},
      {"OffsetBeyondView", [](json& g) { g["accessors"][0]["byteOffset"] = 4; }, "accessors/0", "end at byte 40"},
      {"HugeOffset", [](json& g) { g["accessors"][0]["byteOffset"] = 2147483647; }, "accessors/0", "end at byte"},
      {"ViewBeyondBuffer", [](json& g) { g["bufferViews"][0]["byteLength"] = 2147483647; }, "bufferViews/0",
       "not in a buffer"},
      {"ViewOffsetBeyondBuffer", [](json& g) { g["bufferViews"][0]["byteOffset"] = 2147483647; }, "bufferViews/0",
       "not in a buffer"},
      {"StrideTooSmall", [](json& g) { g["bufferViews"][0]["byteStride"] = 4; }, "accessors/0", "a stride of 4"},
      {"BufferTooLong",
       [](json& g) {
         g["buffers"] = {{{"byteLength", 100000}}};
       },
       "buffers/0", "100000 bytes"},
      {"BufferWithoutBytes",
       [](json& g) {
         g["buffers"] = {{{"byteLength", 0}}, {{"byteLength", 1}}};
       },
       "buffers/1", "neither"},
      {"UnknownComponentType", [](json& g) { g["accessors"][0]["componentType"] = 5124; }, "accessors/0", "5124"},
      {"DoubleComponentType", [](json& g) { g["accessors"][0]["componentType"] = 5130; }, "accessors/0", "5130"},
      {"WrongType", [](json& g) { g["accessors"][0]["type"] = "VEC4"; }, kPrimitive + "/attributes/POSITION", "VEC3"},
      {"UnknownType", [](json& g) { g["accessors"][0]["type"] = "VEC9"; }, "json", "VEC9"},
      {"FewerNormals", [](json& g) { g["accessors"][1]["count"] = 2; }, kPrimitive + "/attributes/NORMAL",
       "2 elements where 3"},
      {"IndicesAreFloats", [](json& g) { g["meshes"][0]["primitives"][0]["indices"] = 2; }, kPrimitive + "/indices",
       "SCALAR"},
      {"JointsAreFloats", [](json& g) { g["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = 5; },
       kPrimitive + "/attributes/JOINTS_0", "unsigned integers"},
      {"JointsWithoutWeights", [](json& g) { g["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0"); },
       kPrimitive + "/attributes", "together"},
      {"JointBeyondSkin", [](json& g) { g["skins"][0]["joints"] = {1}; }, "nodes/0", "joint 1 of a skin with 1"},
      {"FewerMatricesThanJoints", [](json& g) { g["accessors"][8]["count"] = 1; }, "skins/0/inverseBindMatrices",
       "1 matrices for 2 joints"},
      {"NoJoints", [](json& g) { g["skins"][0]["joints"] = json::array(); }, "skins/0/joints", "none"},
      {"UnknownMode", [](json& g) { g["meshes"][0]["primitives"][0]["mode"] = 7; }, kPrimitive + "/mode", "7"},
      {"SparseBeyondAccessor",
       [](json& g) {
         g["accessors"][0]["sparse"] = {
             {"count", 4}, {"indices", {{"bufferView", 0}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}};
       },
       "accessors/0", "replaces 4 of 3"},
      {"SparseIndicesBeyondView",
       [](json& g) {
         g["accessors"][0]["sparse"] = {{"count", 3},
                                        {"indices", {{"bufferView", 0}, {"byteOffset", 34}, {"componentType", 5121}}},
                                        {"values", {{"bufferView", 0}}}};
       },
       "accessors/0/sparse/indices", "end at byte 37"},
      {"SparseIndexTooLarge",
       [](json& g) {
         // The bytes of 1.0f, 0x3f800000, as indices.
         g["accessors"][0]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", 0}, {"byteOffset", 12}, {"componentType", 5125}}},
                                        {"values", {{"bufferView", 0}}}};
       },
       "accessors/0/sparse/indices", "index 1065353216 is beyond the 3"},
      {"UnknownCamera", [](json& g) { g["cameras"][0]["type"] = "fisheye"; }, "json", "fisheye"},
      {"UnknownLight", [](json& g) { g["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "area"; },
       "extensions/KHR_lights_punctual/lights/0/type", "'area'"},
      {"TooFewKeyframeValues", [](json& g) { g["accessors"][9]["count"] = 1; }, "animations/0/samplers/0/output",
       "1 elements where 2"},
      {"TwoBillionKeys",
       [](json& g) {
         g["accessors"].push_back({{"componentType", 5126}, {"count", 2147483647}, {"type", "SCALAR"}});
         g["animations"][0]["samplers"][0]["input"] = 11;
       },
       "animations/0/samplers/0", "numbers in animations", ErrorKind::kTooLarge},
      {"TwoBillionInstances",
       [](json& g) {
         g["accessors"].push_back({{"componentType", 5126}, {"count", 2147483647}, {"type", "VEC3"}});
         g["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = 11;
       },
       "nodes/3/extensions/EXT_mesh_gpu_instancing/attributes", "2147483647 instances", ErrorKind::kTooLarge},
      {"NoInstanceAttribute",
       [](json& g) { g["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = json::object(); },
       "nodes/3/extensions/EXT_mesh_gpu_instancing/attributes", "none of"},
      {"ImageIsNoImage", [](json& g) { g["images"][0]["bufferView"] = 0; }, "images/0", "neither a PNG nor a JPEG",
       ErrorKind::kUnsupported},
      {"ImageWithTwoSources", [](json& g) { g["images"][0]["uri"] = "a.png"; }, "images/0", "either"},
      {"ImageWithoutSource", [](json& g) { g["images"][0].erase("bufferView"); }, "images/0", "either"},
      {"ExternalImage",
       [](json& g) {
         g["images"][0] = {{"uri", "a.png"}};
       },
       "images/0/uri", "outside the file"},
      {"ExternalBuffer",
       [](json& g) {
         g["buffers"] = {{{"byteLength", 1}, {"uri", "a.bin"}}};
       },
       "buffers/0/uri", "outside the file"},
  };
}

std::string break_name(const testing::TestParamInfo<Break>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Types, GltfBroken, testing::ValuesIn(broken_types()), break_name);
INSTANTIATE_TEST_SUITE_P(References, GltfBroken, testing::ValuesIn(broken_references()), break_name);
INSTANTIATE_TEST_SUITE_P(Data, GltfBroken, testing::ValuesIn(broken_data()), break_name);

Error error_of(const ByteVector& glb, const LoadLimits& limits = {}) {
  const Result<Scene> scene = load_glb(glb, limits);
  EXPECT_FALSE(scene.ok());
  return scene ? Error{} : scene.error();
}

TEST(GltfMalformed, PositionsThatAreNotFinite) {
  for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    GltfBuilder builder;
    builder.add_mesh(
        {{"attributes", {{"POSITION", builder.add_accessor<float>({0, 0, 0, 1, value, 0, 0, 1, 0}, "VEC3")}}}});
    const Error error = error_of(builder.glb());
    EXPECT_EQ(error.where, kPrimitive + "/attributes/POSITION");
    EXPECT_THAT(error.what, HasSubstr("element 1 is"));
  }
}

TEST(GltfMalformed, AnIndexOutOfRange) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["indices"] = builder.add_accessor<std::uint32_t>({0, 1, 3}, "SCALAR");
  const Error error = error_of(builder.glb());
  EXPECT_EQ(error.where, kPrimitive + "/indices");
  EXPECT_THAT(error.what, HasSubstr("index 3 (element 2) is beyond the 3 vertices"));
}

TEST(GltfMalformed, ABrokenImage) {
  GltfBuilder builder = rich_gltf();
  const json& view = builder.root["bufferViews"][builder.root["images"][0]["bufferView"].get<std::size_t>()];
  builder.binary[view["byteOffset"].get<std::size_t>() + 45] ^= std::byte{0xff};
  const Error error = error_of(builder.glb());
  EXPECT_EQ(error.where, "images/0");
  EXPECT_EQ(error.kind, ErrorKind::kInvalidInput);
}

TEST(GltfMalformed, LimitsHold) {
  const ByteVector glb = rich_gltf().glb();
  const auto where_over = [&](auto set) {
    LoadLimits limits;
    set(limits);
    const Error error = error_of(glb, limits);
    EXPECT_EQ(error.kind, ErrorKind::kTooLarge) << error.message();
    return error.where;
  };
  EXPECT_EQ(where_over([&](LoadLimits& limits) { limits.max_file_bytes = glb.size() - 1; }), "glb");
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_nodes = 3; }), "nodes");
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_nodes = 5; }),
            "nodes/3/extensions/EXT_mesh_gpu_instancing/attributes");
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_vertices = 2; }), kPrimitive);
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_vertices = 5; }), kPrimitive + "/targets/0");
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_triangles = 0; }), kPrimitive);
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_triangles = 2; }), "nodes");
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_animation_values = 30; }), "skins/0/inverseBindMatrices");
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_animation_values = 35; }), "animations/0/samplers/0");
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_image_pixels = 0; }), "images/0");
  EXPECT_EQ(where_over([](LoadLimits& limits) { limits.max_texture_bytes = 3; }), "images/0");
}

TEST(GltfMalformed, JsonOfEverySortButGltf) {
  for (const char* text : {"", " ", "{", "[]", "null", "1e999", "{\"asset\":", "{\"asset\":{\"version\":\"2.0\"}",
                           "\xff", "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"name\":\"\xc3\x28\"}]}"}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(error_of(make_glb(text, {})).kind, ErrorKind::kInvalidInput);
  }
}

TEST(GltfMalformed, ASyntaxErrorTellsItsPlaceInFewWords) {
  const std::string text = "{\"asset\":{\"version\":\"2.0\"},\"" + std::string(100'000, 'x') + "\n";
  const Error error = error_of(make_glb(text, {}));
  EXPECT_THAT(error.what, testing::StartsWith("parse error at line 2, column 0"));
  EXPECT_LT(error.what.size(), 250u);
}

TEST(GltfMalformed, EndlessNesting) {
  for (const char* opening : {"[", "{\"a\":"}) {
    std::string text = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
    for (int i = 0; i < 1'000'000; ++i) text += opening;
    const Error error = error_of(make_glb(text, {}));
    EXPECT_EQ(error.kind, ErrorKind::kTooLarge);
    EXPECT_EQ(error.where, "json");
  }
}

TEST(GltfMalformed, EndlessValues) {
  std::string text = "{\"asset\":{\"version\":\"2.0\"},\"extras\":[0";
  for (int i = 0; i < 8'000'000; ++i) text += ",0";
  EXPECT_EQ(error_of(make_glb(text + "]}", {})).kind, ErrorKind::kTooLarge);
  text = "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{}";
  for (int i = 0; i < 70'000; ++i) text += ",{}";
  EXPECT_EQ(error_of(make_glb(text + "]}", {})).where, "materials");
}

TEST(GltfMalformed, HostileNamesAreShownShortAndPlain) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.root["extensionsRequired"] = {std::string(10'000, 'x') + "\n\x1b[2J"};
  const Error error = error_of(builder.glb());
  EXPECT_LT(error.what.size(), 200u);
  builder.root["extensionsRequired"] = {"a\n\x1b[2J"};
  EXPECT_THAT(error_of(builder.glb()).what, HasSubstr("'a??[2J'"));
}

TEST(GltfMalformed, EveryTruncationIsAnError) {
  const ByteVector glb = rich_gltf().glb();
  for (std::size_t length = 0; length < glb.size(); ++length)
    EXPECT_FALSE(load_glb(std::span(glb).first(length)).ok()) << length << " of " << glb.size() << " bytes";
}

TEST(GltfMalformed, EveryTruncationWithAHeaderThatAgreesIsAnError) {
  const ByteVector glb = rich_gltf().glb();
  for (std::size_t length = 12; length < glb.size(); ++length) {
    ByteVector part(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(length));
    for (std::size_t i = 0; i < 4; ++i) part[8 + i] = static_cast<std::byte>(length >> 8 * i & 0xff);
    EXPECT_FALSE(load_glb(part).ok()) << length << " of " << glb.size() << " bytes";
  }
}

TEST(GltfMalformed, RandomDamageIsSurvived) {
  const ByteVector whole = rich_gltf().glb();
  const std::size_t json_size = rich_gltf().root.dump().size();
  std::mt19937 random(4711);
  const auto below = [&random](std::size_t bound) { return random() % bound; };
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    ByteVector glb = whole;
    for (std::size_t i = 0, count = 1 + below(8); i < count; ++i) {
      // Every other time within the JSON, where a byte matters more.
      std::byte& byte = round % 2 == 0 ? glb[below(glb.size())] : glb[20 + below(json_size)];
      byte = round % 3 == 0 ? static_cast<std::byte>('0' + below(10)) : static_cast<std::byte>(below(256));
    }
    const Result<Scene> scene = load_glb(glb);
    if (scene) continue;
    ++refused;
    EXPECT_NE(scene.error().kind, ErrorKind::kInternal) << scene.error().message();
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace lightwell
