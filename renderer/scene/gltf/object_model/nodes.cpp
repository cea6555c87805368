#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/gltf/object_model/fields.h"

namespace lightwell::object_model {
namespace {

const auto node_at = [](auto& scene, std::size_t i) -> auto& {
  return scene.nodes[i];
};

/// Translation, rotation and scale of an affine matrix; what it shears is lost. A mirror turns one axis' scale over.
Transform decomposed(const glm::mat4& matrix) {
  Transform transform;
  transform.translation = glm::vec3(matrix[3]);
  glm::mat3 axes(matrix);
  for (int axis = 0; axis < 3; ++axis) transform.scale[axis] = glm::length(axes[axis]);
  if (glm::determinant(axes) < 0.0f) transform.scale.x = -transform.scale.x;
  if (transform.scale.x == 0.0f || transform.scale.y == 0.0f || transform.scale.z == 0.0f) return transform;
  for (int axis = 0; axis < 3; ++axis) axes[axis] /= transform.scale[axis];
  const glm::quat rotation = glm::quat_cast(axes);
  const float length = glm::length(rotation);
  if (std::isfinite(length) && length > 0.0f) transform.rotation = rotation / length;
  return transform;
}

/// glTF allows a matrix or the three others, not both: a node with a matrix gets them in its place.
Transform& local_for_writing(Node& node) {
  if (node.matrix) {
    node.local = decomposed(*node.matrix);
    node.matrix.reset();
  }
  return node.local;
}

void stop_all_motion(Scene& scene, std::size_t node) {
  stop_animating(scene, node, AnimatedProperty::kTranslation);
  stop_animating(scene, node, AnimatedProperty::kRotation);
  stop_animating(scene, node, AnimatedProperty::kScale);
}

/// A quaternion that is not zero, made unit. One that is unit already stays as it is to the last bit.
Status read_rotation(const Json& value, const Range& range, const std::string& where, glm::quat& out) {
  glm::vec4 given;
  const Status read = read_value(value, range, where, given);
  if (!read) return read;
  const glm::dvec4 xyzw(given);
  const double length = glm::length(xyzw);
  if (length < 1e-6) return invalid_input(where, "a rotation of length 0 turns nothing anywhere");
  const glm::vec4 unit = std::abs(length - 1.0) < 1e-6 ? given : glm::vec4(xyzw / length);
  out = glm::quat(unit.w, unit.x, unit.y, unit.z);
  return Done{};
}

Status read_part(const Json& value, const std::string& where, glm::vec3& out) {
  return read_value(value, Range{}, where, out);
}

Status read_part(const Json& value, const std::string& where, glm::quat& out) {
  return read_rotation(value, Range{-1e6, 1e6}, where, out);
}

Json write_part(const glm::vec3& value) {
  return write_value(value);
}

Json write_part(const glm::quat& value) {
  return write_value(glm::vec4(value.x, value.y, value.z, value.w));
}

/// Translation, rotation or scale.
template <class T>
Property part(std::string path, T Transform::*member, AnimatedProperty animated) {
  Property property;
  property.path = std::move(path);
  property.standard = write_part(Transform{}.*member);
  property.get = [member](const Scene& scene, std::size_t i) {
    const Node& node = scene.nodes[i];
    return node.matrix ? std::nullopt : std::optional<Json>(write_part(node.local.*member));
  };
  property.set = [member](Editing& editing, std::size_t i, const Json& value, const std::string& where) {
    return read_part(value, where, local_for_writing(editing.scene.nodes[i]).*member);
  };
  property.reset = [member](Editing& editing, std::size_t i, const std::string&) -> Status {
    local_for_writing(editing.scene.nodes[i]).*member = Transform{}.*member;
    return Done{};
  };
  return followed_by(std::move(property),
                     [animated](Scene& scene, std::size_t node) { stop_animating(scene, node, animated); });
}

Status set_matrix(Editing& editing, std::size_t i, const Json& value, const std::string& where) {
  glm::mat4 matrix;
  const Status read = read_numbers(value, Range{}, where, 16, &matrix[0].x);
  if (!read) return read;
  if (matrix[0].w != 0.0f || matrix[1].w != 0.0f || matrix[2].w != 0.0f || matrix[3].w != 1.0f)
    return invalid_input(where, "must be affine: its last row, elements 3, 7, 11 and 15, is 0, 0, 0, 1");
  editing.scene.nodes[i].matrix = matrix;
  editing.scene.nodes[i].local = {};
  return Done{};
}

Property matrix() {
  Property property;
  property.path = "/matrix";
  property.get = [](const Scene& scene, std::size_t i) {
    const std::optional<glm::mat4>& matrix = scene.nodes[i].matrix;
    return matrix ? std::optional<Json>(write_numbers(&(*matrix)[0].x, 16)) : std::nullopt;
  };
  property.set = set_matrix;
  property.reset = [](Editing& editing, std::size_t i, const std::string&) -> Status {
    editing.scene.nodes[i].matrix.reset();
    return Done{};
  };
  property.set = followed_by(property, stop_all_motion).set;  // a reset touches nothing that could be animated
  return property;
}

std::size_t count_morph_targets(const Scene& scene, const Node& node) {
  if (node.mesh < 0) return 0;
  std::size_t most = 0;
  for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)]->primitives)
    most = std::max(most, primitive.morph_targets.size());
  return most;
}

Status set_weights(Editing& editing, std::size_t i, const Json& value, const std::string& where) {
  Node& node = editing.scene.nodes[i];
  const std::size_t targets = count_morph_targets(editing.scene, node);
  if (targets == 0) return invalid_input(where, "the node's mesh has no morph targets");
  std::vector<float> weights(targets);
  const Status read = read_numbers(value, Range{-1e6, 1e6}, where, targets, weights.data());
  if (read) node.weights = std::move(weights);
  return read;
}

Property weights() {
  Property property;
  property.path = "/weights";
  property.get = [](const Scene& scene, std::size_t i) {
    const std::vector<float>& weights = scene.nodes[i].weights;
    return weights.empty() ? std::nullopt : std::optional<Json>(write_numbers(weights.data(), weights.size()));
  };
  property.set = set_weights;
  property.reset = [](Editing& editing, std::size_t i, const std::string&) -> Status {
    editing.scene.nodes[i].weights.clear();
    return Done{};
  };
  return followed_by(std::move(property),
                     [](Scene& scene, std::size_t node) { stop_animating(scene, node, AnimatedProperty::kWeights); });
}

/// Another mesh has other morph targets: the weights given for the earlier one go with it.
Property mesh() {
  return followed_by(reference(node_at, "/mesh", &Node::mesh, meshes), [](Scene& scene, std::size_t node) {
    scene.nodes[node].weights.clear();
    stop_animating(scene, node, AnimatedProperty::kWeights);
  });
}

Result<std::vector<int>> read_nodes(Editing& editing, const Json& value, const std::string& where) {
  if (!value.is_array()) return invalid_input(where, "must be an array of nodes, not " + in_words(value));
  const Status affordable = editing.spend(16 * value.size(), where);
  if (!affordable) return affordable.error();
  std::vector<int> indices;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Result<int> node = read_reference(editing, nodes(), value[i], where + '/' + std::to_string(i));
    if (!node) return node.error();
    indices.push_back(*node);
  }
  return indices;
}

/// A list of nodes; `get` gives it and `assign` sets it.
template <class Get, class Assign>
Property node_list(std::string path, Get get, Assign assign) {
  Property property;
  property.path = std::move(path);
  property.is_list = true;
  property.standard = Json::array();
  property.get = [get](const Scene& scene, std::size_t i) { return std::optional<Json>(get(scene, i)); };
  property.set = [assign](Editing& editing, std::size_t i, const Json& value, const std::string& where) -> Status {
    const Result<std::vector<int>> indices = read_nodes(editing, value, where);
    return indices ? assign(editing, i, *indices, where) : indices.error();
  };
  property.reset = [assign](Editing& editing, std::size_t i, const std::string& where) {
    return assign(editing, i, {}, where);
  };
  return property;
}

std::vector<Property> node_properties() {
  return {
      field(node_at, "/name", &Node::name),
      matrix(),
      part("/translation", &Transform::translation, AnimatedProperty::kTranslation),
      part("/rotation", &Transform::rotation, AnimatedProperty::kRotation),
      part("/scale", &Transform::scale, AnimatedProperty::kScale),
      mesh(),
      weights(),
      reference(node_at, "/skin", &Node::skin, skins),
      reference(node_at, "/camera", &Node::camera, cameras),
      reference(node_at, "/extensions/KHR_lights_punctual/light", &Node::light, lights),
      field(node_at, "/extensions/KHR_node_visibility/visible", &Node::visible),
      node_list(
          "/children", [](const Scene& scene, std::size_t i) { return scene.nodes[i].children; }, set_children),
  };
}

Status check_whole_node(const Json& node, const std::string& where) {
  for (const char* part : {"translation", "rotation", "scale"})
    if (node.contains("matrix") && node.contains(part))
      return invalid_input(where, "has both a matrix and a " + std::string(part));
  return Done{};
}

}  // namespace

const ObjectKind& nodes() {
  static const ObjectKind kind = [] {
    ObjectKind nodes;
    nodes.singular = "node";
    nodes.pointer = "/nodes";
    nodes.properties = node_properties();
    nodes.count = [](const Scene& scene) { return scene.nodes.size(); };
    nodes.name = [](const Scene& scene, std::size_t i) -> const std::string& { return scene.nodes[i].name; };
    nodes.insert = insert_node;
    nodes.erase = erase_node;
    nodes.most = &EditLimits::max_nodes;
    nodes.check_whole = check_whole_node;
    return nodes;
  }();
  return kind;
}

const ObjectKind& scenes() {
  static const ObjectKind kind = [] {
    ObjectKind scenes;
    scenes.singular = "scene";
    scenes.pointer = "/scenes";
    scenes.properties = {node_list(
        "/nodes", [](const Scene& scene, std::size_t) { return scene.roots; },
        [](Editing& editing, std::size_t, const std::vector<int>& roots, const std::string& where) {
          return set_roots(editing, roots, where);
        })};
    scenes.count = [](const Scene&) { return std::size_t{1}; };
    return scenes;
  }();
  return kind;
}

}  // namespace lightwell::object_model
