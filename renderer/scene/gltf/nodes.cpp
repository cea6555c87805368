#include "renderer/scene/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/scene/gltf/instancing.h"
#include "renderer/scene/gltf/numbers.h"
#include "renderer/scene/gltf/skins.h"

namespace lightwell::gltf {
namespace {

std::string node_path(int index) {
  return join("nodes", static_cast<std::size_t>(index));
}

glm::vec3 vector_or(const std::vector<double>& values, glm::vec3 fallback) {
  if (values.size() != 3) return fallback;
  return {to_float(values[0]), to_float(values[1]), to_float(values[2])};
}

glm::quat read_rotation(Context& context, const std::vector<double>& xyzw, const std::string& where) {
  const glm::quat identity(1.0f, 0.0f, 0.0f, 0.0f);
  if (xyzw.size() != 4) return identity;
  const double length = std::sqrt(std::inner_product(xyzw.begin(), xyzw.end(), xyzw.begin(), 0.0));
  if (!(length > 1e-12) || !std::isfinite(length)) {
    context.warnings.add(where, "the rotation is no quaternion of any length; none is applied");
    return identity;
  }
  return {static_cast<float>(xyzw[3] / length), static_cast<float>(xyzw[0] / length),
          static_cast<float>(xyzw[1] / length), static_cast<float>(xyzw[2] / length)};
}

glm::mat4 read_matrix(Context& context, const std::vector<double>& values, const std::string& where) {
  glm::mat4 matrix;
  for (std::size_t i = 0; i < 16; ++i)
    matrix[static_cast<glm::length_t>(i / 4)][static_cast<glm::length_t>(i % 4)] = to_float(values[i]);
  if (glm::vec4(matrix[0].w, matrix[1].w, matrix[2].w, matrix[3].w) != glm::vec4(0, 0, 0, 1)) {
    context.warnings.add(where, "the matrix has a last row other than 0 0 0 1, which is ignored");
    for (glm::length_t column = 0; column < 4; ++column) matrix[column].w = column == 3 ? 1.0f : 0.0f;
  }
  return matrix;
}

/// An index that, unless it is kNone, must be one of `elements`.
template <class Element>
int checked(int index, const std::vector<Element>& elements, const std::string& where) {
  if (index != kNone) at(elements, index, where);
  return index;
}

Node read_node(Context& context, const Scene& scene, const tinygltf::Node& source, const std::string& where) {
  Node node;
  node.name = source.name;
  if (!source.matrix.empty()) {
    node.matrix = read_matrix(context, source.matrix, where);
  } else {
    node.local.translation = vector_or(source.translation, node.local.translation);
    node.local.rotation = read_rotation(context, source.rotation, where);
    node.local.scale = vector_or(source.scale, node.local.scale);
  }
  node.mesh = checked(source.mesh, scene.meshes, join(where, "mesh"));
  node.camera = checked(source.camera, scene.cameras, join(where, "camera"));
  node.skin = checked(source.skin, scene.skins, join(where, "skin"));
  if (const tinygltf::Value* light = find_extension(source.extensions, "KHR_lights_punctual"))
    node.light =
        checked(index_or(*light, "light", kNone), scene.lights, join(where, "extensions/KHR_lights_punctual/light"));
  if (const tinygltf::Value* visibility = find_extension(source.extensions, "KHR_node_visibility"))
    node.visible = !visibility->Has("visible") || visibility->Get("visible").Get<bool>();
  return node;
}

void read_weights(Context& context, const Scene& scene, const tinygltf::Node& source, const std::string& where,
                  Node& node) {
  if (source.weights.empty()) return;
  const std::size_t count = node.mesh == kNone ? 0 : scene.meshes[static_cast<std::size_t>(node.mesh)]->weights.size();
  if (source.weights.size() != count) {
    context.warnings.add(where, "has " + std::to_string(source.weights.size()) + " weights for " +
                                    std::to_string(count) + " morph targets; ignored");
    return;
  }
  for (const double weight : source.weights) node.weights.push_back(to_float(weight));
}

/// Sets children and parents, every node one parent at most.
void connect(const std::vector<tinygltf::Node>& sources, std::vector<Node>& nodes) {
  for (std::size_t i = 0; i < sources.size(); ++i) {
    for (const int child : sources[i].children) {
      const std::string where = join(join("nodes", i), "children");
      at(nodes, child, where);
      Node& node = nodes[static_cast<std::size_t>(child)];
      if (node.parent != kNone)
        fail(where, "node " + std::to_string(child) + " is already a child of node " + std::to_string(node.parent));
      node.parent = static_cast<int>(i);
    }
    nodes[i].children = sources[i].children;
  }
}

/// Marks what hangs below `roots`, themselves included. Terminates for whatever has one parent each.
std::vector<bool> below(const std::vector<Node>& nodes, std::vector<int> roots) {
  std::vector<bool> found(nodes.size(), false);
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const auto node = static_cast<std::size_t>(roots[i]);
    found[node] = true;
    const std::vector<int>& children = nodes[node].children;
    roots.insert(roots.end(), children.begin(), children.end());
  }
  return found;
}

std::vector<int> nodes_without_parent(const std::vector<Node>& nodes) {
  std::vector<int> roots;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].parent == kNone) roots.push_back(static_cast<int>(i));
  return roots;
}

/// With one parent each, nodes that hang below no root hang below themselves.
void refuse_circles(const std::vector<Node>& nodes) {
  const std::vector<bool> found = below(nodes, nodes_without_parent(nodes));
  const auto circular = std::find(found.begin(), found.end(), false);
  if (circular != found.end()) fail(node_path(static_cast<int>(circular - found.begin())), "is its own ancestor");
}

/// The scene to show: the default one, else the first, else everything.
std::vector<int> read_roots(Context& context, const std::vector<Node>& nodes, Scene& scene) {
  const tinygltf::Model& model = context.document.model;
  if (model.scenes.empty()) {
    if (model.defaultScene != kNone) fail("scene", "there are no scenes");
    return nodes_without_parent(nodes);
  }
  const int shown = std::max(model.defaultScene, 0);
  const tinygltf::Scene& source = at(model.scenes, shown, "scene");
  scene.name = source.name;
  if (model.scenes.size() > 1)
    context.warnings.add("scenes", "of " + std::to_string(model.scenes.size()) + " scenes only number " +
                                       std::to_string(shown) + " is shown");
  const std::string where = join(join("scenes", static_cast<std::size_t>(shown)), "nodes");
  std::vector<bool> listed(nodes.size(), false);
  for (const int root : source.nodes) {
    if (at(nodes, root, where).parent != kNone)
      fail(where, "node " + std::to_string(root) + " is not a root but a child of node " +
                      std::to_string(nodes[static_cast<std::size_t>(root)].parent));
    if (listed[static_cast<std::size_t>(root)]) fail(where, "node " + std::to_string(root) + " is listed twice");
    listed[static_cast<std::size_t>(root)] = true;
  }
  return source.nodes;
}

/// Nodes of other scenes keep their numbers but show nothing.
void empty_unseen(const std::vector<int>& roots, std::vector<Node>& nodes) {
  const std::vector<bool> seen = below(nodes, roots);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!seen[i]) nodes[i].mesh = nodes[i].camera = nodes[i].light = nodes[i].skin = kNone;
}

}  // namespace

void read_nodes(Context& context, Scene& scene) {
  const std::vector<tinygltf::Node>& sources = context.document.model.nodes;
  read_skins(context, scene);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::string where = join("nodes", i);
    scene.nodes.push_back(read_node(context, scene, sources[i], where));
    read_weights(context, scene, sources[i], where, scene.nodes.back());
  }
  connect(sources, scene.nodes);
  refuse_circles(scene.nodes);
  scene.roots = read_roots(context, scene.nodes, scene);
  empty_unseen(scene.roots, scene.nodes);
  check_skins(context, scene);
  expand_instances(context, scene);
  if (const std::uint64_t count = count_triangles(scene); count > context.limits.max_triangles)
    fail("nodes",
         "show " + std::to_string(count) + " triangles; at most " + std::to_string(context.limits.max_triangles) +
             " are allowed",
         ErrorKind::kTooLarge);
}

}  // namespace lightwell::gltf
