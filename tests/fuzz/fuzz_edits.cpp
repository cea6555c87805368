// Patches of a small scene: JSON as it comes, or (first byte odd) operations drawn from a list of paths and values.
// A patch that is refused changes nothing; one that goes through leaves a scene whose every index means something.
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <span>
#include <string_view>

#include "renderer/scene/gltf/edit.h"
#include "renderer/scene/pose.h"

namespace lightwell {
namespace {

using Json = nlohmann::json;

void require(bool holds, const char* what) {
  if (holds) return;
  std::cerr << what << '\n';
  std::abort();
}

/// Three nodes in a row and three alone; a skin, an animation, two meshes one of which morphs.
Scene make_scene() {
  Scene scene;
  scene.materials.resize(3);
  for (int material = 0; material < 2; ++material) {
    auto mesh = std::make_shared<Mesh>();
    Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.normals.assign(3, {0, 0, 1});
    primitive.tangents.assign(3, {1, 0, 0, 1});
    primitive.joints.assign(3, {0, 0, 0, 0});
    primitive.weights.assign(3, {1, 0, 0, 0});
    primitive.indices = {0, 1, 2};
    primitive.material = material;
    if (material == 1) primitive.morph_targets.resize(2, {primitive.positions, {}, {}});
    mesh->name = "mesh";
    mesh->primitives.push_back(std::move(primitive));
    scene.meshes.push_back(std::move(mesh));
  }
  scene.nodes.resize(6);
  for (std::size_t i = 0; i < 6; ++i) scene.nodes[i].name = std::string(1, static_cast<char>('a' + i));
  for (int i = 0; i < 2; ++i) {
    scene.nodes[static_cast<std::size_t>(i)].children = {i + 1};
    scene.nodes[static_cast<std::size_t>(i + 1)].parent = i;
  }
  scene.roots = {0, 3, 4, 5};
  scene.nodes[2].mesh = 1;
  scene.nodes[2].skin = 0;
  scene.nodes[3].light = 1;
  scene.nodes[5].camera = 0;
  scene.textures.resize(2);
  scene.lights.resize(2);
  scene.lights[1].kind = LightKind::kSpot;
  scene.cameras.resize(1);
  scene.skins = {Skin{"skin", {4}, {glm::mat4(1.0f)}}};
  scene.animations.resize(1);
  scene.animations[0].channels = {
      {1, AnimatedProperty::kTranslation, Interpolation::kLinear, {0.0f, 1.0f}, {0, 0, 0, 1, 1, 1}, 3},
      {2, AnimatedProperty::kWeights, Interpolation::kLinear, {0.0f, 1.0f}, {0, 1, 1, 0}, 2}};
  scene.animations[0].light_channels = {
      {1, LightChannel::Property::kIntensity, Interpolation::kLinear, {0.0f, 1.0f}, {0, 1}}};
  scene.animations[0].duration_s = 1.0f;
  return scene;
}

bool is_index(int i, std::size_t count, bool may_be_none = true) {
  return (may_be_none && i == -1) || (i >= 0 && static_cast<std::size_t>(i) < count);
}

void check_hierarchy(const Scene& scene) {
  std::vector<int> named(scene.nodes.size(), 0);
  for (const int root : scene.roots) {
    require(is_index(root, scene.nodes.size(), false), "a root that is none");
    require(scene.nodes[static_cast<std::size_t>(root)].parent == -1, "a root with a parent");
    ++named[static_cast<std::size_t>(root)];
  }
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    for (const int child : scene.nodes[i].children) {
      require(is_index(child, scene.nodes.size(), false), "a child that is none");
      require(scene.nodes[static_cast<std::size_t>(child)].parent == static_cast<int>(i), "a child of another parent");
      ++named[static_cast<std::size_t>(child)];
    }
    int above = static_cast<int>(i);
    for (std::size_t step = 0; above != -1; ++step) {
      require(step <= scene.nodes.size(), "a cycle");
      above = scene.nodes[static_cast<std::size_t>(above)].parent;
    }
  }
  for (const int times : named) require(times <= 1, "a node in two places");
}

void check_indices(const Scene& scene) {
  for (const Node& node : scene.nodes) {
    require(is_index(node.mesh, scene.meshes.size()) && is_index(node.camera, scene.cameras.size()), "a node's index");
    require(is_index(node.light, scene.lights.size()) && is_index(node.skin, scene.skins.size()), "a node's index");
    require(is_index(node.parent, scene.nodes.size()), "a parent that is none");
    const float length = glm::length(node.local.rotation);
    require(length > 0.999f && length < 1.001f, "a rotation that is not unit");
  }
  for (const auto& mesh : scene.meshes)
    for (const Primitive& primitive : mesh->primitives)
      require(is_index(primitive.material, scene.materials.size()), "a primitive's material");
  for (const int joint : scene.skins[0].joints) require(is_index(joint, scene.nodes.size(), false), "a joint");
  for (const AnimationChannel& channel : scene.animations[0].channels)
    require(is_index(channel.node, scene.nodes.size(), false), "a channel's node");
  for (const LightChannel& channel : scene.animations[0].light_channels)
    require(is_index(channel.light, scene.lights.size(), false), "a channel's light");
  for (const Light& light : scene.lights) require(light.inner_cone_angle < light.outer_cone_angle, "a spot's cone");
}

constexpr std::string_view kPaths[] = {"/nodes/-",
                                       "/nodes/0",
                                       "/nodes/1",
                                       "/nodes/b",
                                       "/nodes/4",
                                       "/nodes/0/children",
                                       "/nodes/1/children/-",
                                       "/nodes/2/children/0",
                                       "/nodes/3/children/-",
                                       "/scenes/0/nodes",
                                       "/scenes/0/nodes/-",
                                       "/scenes/0/nodes/0",
                                       "/nodes/1/translation",
                                       "/nodes/1/rotation",
                                       "/nodes/1/scale/2",
                                       "/nodes/1/matrix",
                                       "/nodes/2/weights",
                                       "/nodes/2/weights/0",
                                       "/nodes/2/mesh",
                                       "/nodes/3/camera",
                                       "/nodes/3/skin",
                                       "/nodes/3/name",
                                       "/nodes/3/extensions/KHR_lights_punctual/light",
                                       "/nodes/3/extensions",
                                       "/materials/-",
                                       "/materials/0",
                                       "/materials/1",
                                       "/materials/0/pbrMetallicRoughness",
                                       "/materials/0/pbrMetallicRoughness/baseColorFactor/1",
                                       "/materials/0/normalTexture",
                                       "/materials/0/extensions/KHR_materials_unlit",
                                       "/meshes/0/primitives/0/material",
                                       "/meshes/1/primitives/0/material",
                                       "/extensions/KHR_lights_punctual/lights/-",
                                       "/extensions/KHR_lights_punctual/lights/0",
                                       "/extensions/KHR_lights_punctual/lights/1/spot",
                                       "/extensions/KHR_lights_punctual/lights/1/intensity",
                                       "/cameras/-",
                                       "/cameras/0",
                                       "/cameras/0/perspective",
                                       "/extensions/LIGHTWELL_environment",
                                       "/extensions/LIGHTWELL_environment/zenith/0",
                                       "/animations/0",
                                       ""};

constexpr std::string_view kValues[] = {
    "0",
    "1",
    "2",
    "3",
    "-1",
    "0.5",
    "1e30",
    "\"a\"",
    "\"b\"",
    "\"mesh\"",
    "true",
    "null",
    "[]",
    "[0]",
    "[1]",
    "[2,3]",
    "[1,1]",
    "[\"c\"]",
    "[0,0,0]",
    "[1,2,3]",
    "[0,0,0,0]",
    "[0,3,0,4]",
    "[1,0,0,0,0,2,0,0,0,0,3,0,4,5,6,1]",
    "[1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1]",
    "{}",
    R"({"name":"a","children":[0]})",
    R"({"mesh":1,"weights":[0.5,1],"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}})",
    R"({"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}})",
    R"({"index":1,"texCoord":1})",
    R"({"normalTexture":{"index":0,"scale":2},"extensions":{"KHR_materials_unlit":{}}})",
    R"({"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0,"zfar":5}})"};

Json drawn_patch(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kOps[] = {"add", "remove", "replace", "test"};
  Json patch = Json::array();
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3)
    patch.push_back({{"op", kOps[bytes[i] % std::size(kOps)]},
                     {"path", kPaths[bytes[i + 1] % std::size(kPaths)]},
                     {"value", Json::parse(kValues[bytes[i + 2] % std::size(kValues)])}});
  return patch;
}

void try_patch(const Json& patch) {
  static const Scene original = make_scene();
  Scene scene = original;
  const Node* const untouched = scene.nodes.data();  // a patch works on a copy: what it leaves alone keeps its address
  const Status applied = apply_edits(scene, patch);
  if (!applied) {
    require(!applied.error().what.empty(), "an error that says nothing");
    require(scene.nodes.data() == untouched, "a refused patch left something behind");
    return;
  }
  check_hierarchy(scene);
  check_indices(scene);
  static_cast<void>(describe_scene(scene));
  static_cast<void>(pose_at(scene, 0.5));
  for (int mesh = 0; mesh < 2; ++mesh)
    require(original.meshes[static_cast<std::size_t>(mesh)]->primitives[0].material == mesh, "a shared mesh changed");
}

}  // namespace
}  // namespace lightwell

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  if (data[0] % 2 == 1) {
    lightwell::try_patch(lightwell::drawn_patch({data + 1, size - 1}));
    return 0;
  }
  const nlohmann::json patch = nlohmann::json::parse(data + 1, data + size, nullptr, false);
  if (!patch.is_discarded()) lightwell::try_patch(patch);
  return 0;
}
