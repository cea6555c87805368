#include "renderer/scene/gltf/instancing.h"

#include <optional>

#include "renderer/scene/gltf/accessors.h"
#include "renderer/scene/gltf/vertex_attributes.h"

namespace lightwell::gltf {
namespace {

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

std::map<std::string, int> attributes_of(const tinygltf::Value& extension) {
  std::map<std::string, int> attributes;
  const tinygltf::Value& given = extension.Get("attributes");
  for (const std::string& name : given.Keys()) attributes.emplace(name, given.Get(name).GetNumberAsInt());
  return attributes;
}

glm::quat rotation_from(const glm::vec4& xyzw) {
  const float length = glm::length(xyzw);
  if (!(length > 1e-6f)) return {1.0f, 0.0f, 0.0f, 0.0f};
  return glm::quat(xyzw.w, xyzw.x, xyzw.y, xyzw.z) / length;
}

/// The transforms of a node's instances.
std::vector<Transform> read_instances(const Context& context, const std::map<std::string, int>& attributes,
                                      std::size_t most, const std::string& where) {
  std::optional<std::size_t> count;
  for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"})
    if (const int accessor = find_attribute(attributes, name); accessor != kNone && !count)
      count = find_accessor(context, accessor, join(where, name)).count;
  if (!count) fail(where, "has none of TRANSLATION, ROTATION and SCALE");
  if (*count > most)
    fail(where, std::to_string(*count) + " instances are more than the nodes allowed", ErrorKind::kTooLarge);
  std::vector<Transform> transforms(*count);
  if (const int accessor = find_attribute(attributes, "TRANSLATION"); accessor != kNone) {
    const auto values = read_accessor<glm::vec3>(context, accessor, *count, join(where, "TRANSLATION"));
    for (std::size_t i = 0; i < *count; ++i) transforms[i].translation = values[i];
  }
  if (const int accessor = find_attribute(attributes, "ROTATION"); accessor != kNone) {
    const auto values = read_accessor<glm::vec4>(context, accessor, *count, join(where, "ROTATION"));
    for (std::size_t i = 0; i < *count; ++i) transforms[i].rotation = rotation_from(values[i]);
  }
  if (const int accessor = find_attribute(attributes, "SCALE"); accessor != kNone) {
    const auto values = read_accessor<glm::vec3>(context, accessor, *count, join(where, "SCALE"));
    for (std::size_t i = 0; i < *count; ++i) transforms[i].scale = values[i];
  }
  return transforms;
}

void add_children(Scene& scene, std::size_t parent, const std::vector<Transform>& transforms) {
  const Node prototype = scene.nodes[parent];
  for (const Transform& transform : transforms) {
    scene.nodes[parent].children.push_back(static_cast<int>(scene.nodes.size()));
    Node& child = scene.nodes.emplace_back();
    child.parent = static_cast<int>(parent);
    child.local = transform;
    child.mesh = prototype.mesh;
    child.weights = prototype.weights;
  }
  scene.nodes[parent].mesh = kNone;
  scene.nodes[parent].weights.clear();
}

}  // namespace

void expand_instances(Context& context, Scene& scene) {
  const std::vector<tinygltf::Node>& sources = context.document.model.nodes;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const tinygltf::Value* extension = find_extension(sources[i].extensions, kExtension);
    if (!extension || scene.nodes[i].mesh == kNone) continue;
    const std::string where = join(join("nodes", i), std::string("extensions/") + kExtension + "/attributes");
    if (scene.nodes[i].skin != kNone) {
      context.warnings.add(where, "a skinned mesh cannot have instances; ignored");
      continue;
    }
    add_children(
        scene, i,
        read_instances(context, attributes_of(*extension), context.limits.max_nodes - scene.nodes.size(), where));
  }
}

}  // namespace lightwell::gltf
