#include "renderer/scene/gltf/object_model/editing.h"

#include <algorithm>

namespace lightwell::object_model {
namespace {

constexpr int kNone = -1;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

bool has_twice(std::vector<int> values) {
  std::sort(values.begin(), values.end());
  return std::adjacent_find(values.begin(), values.end()) != values.end();
}

Error refuse_child(const std::string& where, int child, const std::string& why) {
  return invalid_input(where, "node " + std::to_string(child) + ' ' + why);
}

/// `node` itself and all above it, sorted.
std::vector<int> ancestors(const Scene& scene, int node) {
  std::vector<int> line;
  for (; node != kNone; node = scene.nodes[index(node)].parent) line.push_back(node);
  std::sort(line.begin(), line.end());
  return line;
}

template <class Animated>
void drop_channels(std::vector<Animated>& channels, const auto& is_dropped) {
  channels.erase(std::remove_if(channels.begin(), channels.end(), is_dropped), channels.end());
}

void end_empty_animations(Scene& scene) {
  for (Animation& animation : scene.animations)
    if (animation.channels.empty() && animation.light_channels.empty()) animation.duration_s = 0.0f;
}

/// Calls `visit(int&)` on each index of a node; those that are none included.
template <class Visit>
void for_each_node_index(Scene& scene, Visit visit) {
  for (Node& node : scene.nodes) {
    visit(node.parent);
    for (int& child : node.children) visit(child);
  }
  for (int& root : scene.roots) visit(root);
  for (Skin& skin : scene.skins)
    for (int& joint : skin.joints) visit(joint);
  for (Animation& animation : scene.animations)
    for (AnimationChannel& channel : animation.channels) visit(channel.node);
}

template <class Visit>
void for_each_light_index(Scene& scene, Visit visit) {
  for (Node& node : scene.nodes) visit(node.light);
  for (Animation& animation : scene.animations)
    for (LightChannel& channel : animation.light_channels) visit(channel.light);
}

/// Visits primitives whose material is `first` or later; a mesh without one stays shared.
template <class Visit>
void for_each_material_index(Editing& editing, std::size_t first, Visit visit) {
  const auto is_meant = [&](const Primitive& primitive) {
    return primitive.material != kNone && index(primitive.material) >= first;
  };
  for (std::size_t m = 0; m < editing.scene.meshes.size(); ++m) {
    const std::vector<Primitive>& primitives = editing.scene.meshes[m]->primitives;
    if (std::none_of(primitives.begin(), primitives.end(), is_meant)) continue;
    for (Primitive& primitive : editing.mesh_for_writing(m).primitives)
      if (is_meant(primitive)) visit(primitive.material);
  }
}

auto moved_up_from(std::size_t first) {
  return [first](int& reference) {
    if (reference != kNone && index(reference) >= first) ++reference;
  };
}

auto moved_down_from(std::size_t removed) {
  return [removed](int& reference) {
    if (reference == kNone) return;
    if (index(reference) == removed)
      reference = kNone;
    else if (index(reference) > removed)
      --reference;
  };
}

template <class T>
auto place(std::vector<T>& elements, std::size_t i) {
  return elements.begin() + static_cast<std::ptrdiff_t>(i);
}

/// What it costs to look at every index in the scene.
std::size_t all_indices(const Scene& scene) {
  return 2 * scene.nodes.size() + 64;
}

}  // namespace

Status Editing::spend(std::size_t steps, const std::string& where) {
  constexpr std::uint64_t kMost = 100'000'000;
  steps_ += steps;
  if (steps_ <= kMost) return Done{};
  return Error{ErrorKind::kTooLarge, where, "the patch asks for more work than one patch may; split it"};
}

Mesh& Editing::mesh_for_writing(std::size_t mesh) {
  own_meshes_.resize(scene.meshes.size());
  if (!own_meshes_[mesh]) {
    own_meshes_[mesh] = std::make_shared<Mesh>(*scene.meshes[mesh]);
    scene.meshes[mesh] = own_meshes_[mesh];
  }
  return *own_meshes_[mesh];
}

Status set_children(Editing& editing, std::size_t node, const std::vector<int>& children, const std::string& where) {
  Scene& scene = editing.scene;
  const int self = static_cast<int>(node);
  if (has_twice(children)) return invalid_input(where, "a node occurs twice");
  const std::vector<int> above = ancestors(scene, self);
  const Status affordable = editing.spend(4 * (above.size() + children.size()) + scene.roots.size(), where);
  if (!affordable) return affordable;
  for (const int child : children) {
    const int parent = scene.nodes[index(child)].parent;
    if (std::binary_search(above.begin(), above.end(), child))
      return refuse_child(where, child, "would be its own ancestor");
    if (parent != kNone && parent != self)
      return refuse_child(where, child, "is a child of node " + std::to_string(parent) + "; remove it there first");
  }
  for (const int child : scene.nodes[node].children) scene.nodes[index(child)].parent = kNone;
  for (const int child : children) scene.nodes[index(child)].parent = self;
  scene.nodes[node].children = children;
  scene.roots.erase(std::remove_if(scene.roots.begin(), scene.roots.end(),
                                   [&](int root) { return scene.nodes[index(root)].parent != kNone; }),
                    scene.roots.end());
  return Done{};
}

Status set_roots(Editing& editing, const std::vector<int>& roots, const std::string& where) {
  Scene& scene = editing.scene;
  const Status affordable = editing.spend(4 * roots.size(), where);
  if (!affordable) return affordable;
  if (has_twice(roots)) return invalid_input(where, "a node occurs twice");
  for (const int root : roots) {
    const int parent = scene.nodes[index(root)].parent;
    if (parent != kNone)
      return refuse_child(where, root, "is a child of node " + std::to_string(parent) + "; remove it there first");
  }
  scene.roots = roots;
  return Done{};
}

void stop_animating(Scene& scene, std::size_t node, AnimatedProperty property) {
  for (Animation& animation : scene.animations)
    drop_channels(animation.channels, [&](const AnimationChannel& channel) {
      return channel.node == static_cast<int>(node) && channel.property == property;
    });
  end_empty_animations(scene);
}

void stop_animating(Scene& scene, std::size_t light, LightChannel::Property property) {
  for (Animation& animation : scene.animations)
    drop_channels(animation.light_channels, [&](const LightChannel& channel) {
      return channel.light == static_cast<int>(light) && channel.property == property;
    });
  end_empty_animations(scene);
}

void insert_node(Editing& editing, std::size_t index) {
  Scene& scene = editing.scene;
  if (index < scene.nodes.size()) for_each_node_index(scene, moved_up_from(index));
  scene.nodes.insert(place(scene.nodes, index), Node{});
  scene.roots.push_back(static_cast<int>(index));
}

void insert_material(Editing& editing, std::size_t index) {
  for_each_material_index(editing, index, moved_up_from(index));
  editing.scene.materials.insert(place(editing.scene.materials, index), Material{});
}

void insert_light(Editing& editing, std::size_t index) {
  for_each_light_index(editing.scene, moved_up_from(index));
  editing.scene.lights.insert(place(editing.scene.lights, index), Light{});
}

void insert_camera(Editing& editing, std::size_t index) {
  for (Node& node : editing.scene.nodes) moved_up_from(index)(node.camera);
  editing.scene.cameras.insert(place(editing.scene.cameras, index), Camera{});
}

Status erase_node(Editing& editing, std::size_t index, const std::string& where) {
  Scene& scene = editing.scene;
  const int removed = static_cast<int>(index);
  for (std::size_t s = 0; s < scene.skins.size(); ++s) {
    const std::vector<int>& joints = scene.skins[s].joints;
    if (std::find(joints.begin(), joints.end(), removed) != joints.end())
      return invalid_input(where, "is a joint of skin " + std::to_string(s) + " and cannot be removed");
  }
  const auto drop = [removed](std::vector<int>& nodes) {
    nodes.erase(std::remove(nodes.begin(), nodes.end(), removed), nodes.end());
  };
  if (scene.nodes[index].parent != kNone)
    drop(scene.nodes[static_cast<std::size_t>(scene.nodes[index].parent)].children);
  drop(scene.roots);
  for (Animation& animation : scene.animations)
    drop_channels(animation.channels, [&](const AnimationChannel& channel) { return channel.node == removed; });
  end_empty_animations(scene);
  scene.nodes.erase(place(scene.nodes, index));
  for_each_node_index(scene, moved_down_from(index));
  return editing.spend(all_indices(scene), where);
}

Status erase_material(Editing& editing, std::size_t index, const std::string& where) {
  for_each_material_index(editing, index, moved_down_from(index));
  editing.scene.materials.erase(place(editing.scene.materials, index));
  return editing.spend(editing.scene.meshes.size(), where);
}

Status erase_light(Editing& editing, std::size_t index, const std::string& where) {
  for (Animation& animation : editing.scene.animations)
    drop_channels(animation.light_channels,
                  [&](const LightChannel& channel) { return channel.light == static_cast<int>(index); });
  end_empty_animations(editing.scene);
  for_each_light_index(editing.scene, moved_down_from(index));
  editing.scene.lights.erase(place(editing.scene.lights, index));
  return editing.spend(all_indices(editing.scene), where);
}

Status erase_camera(Editing& editing, std::size_t index, const std::string& where) {
  for (Node& node : editing.scene.nodes) moved_down_from(index)(node.camera);
  editing.scene.cameras.erase(place(editing.scene.cameras, index));
  return editing.spend(all_indices(editing.scene), where);
}

}  // namespace lightwell::object_model
