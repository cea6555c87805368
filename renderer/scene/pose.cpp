#include "renderer/scene/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/animation.h"

namespace lightwell {
namespace {

constexpr int kNone = -1;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

/// What animations change, for one moment.
struct AnimatedState {
  std::vector<Transform> locals;            // one per node
  std::vector<std::vector<float>> weights;  // one per node if any channel animates weights, else empty
  std::vector<Light> lights;
};

void apply_channel(const AnimationChannel& channel, float time_s, AnimatedState& state) {
  if (channel.node < 0 || index(channel.node) >= state.locals.size()) return;
  Transform& local = state.locals[index(channel.node)];
  switch (channel.property) {
    case AnimatedProperty::kTranslation:
      sample_keyframes(channel.times_s, channel.values, channel.interpolation, time_s, {&local.translation.x, 3});
      break;
    case AnimatedProperty::kScale:
      sample_keyframes(channel.times_s, channel.values, channel.interpolation, time_s, {&local.scale.x, 3});
      break;
    case AnimatedProperty::kRotation:
      sample_rotation(channel.times_s, channel.values, channel.interpolation, time_s, local.rotation);
      break;
    case AnimatedProperty::kWeights: {
      state.weights.resize(state.locals.size());
      std::vector<float>& weights = state.weights[index(channel.node)];
      weights.resize(index(std::max(channel.width, 0)));
      if (!sample_keyframes(channel.times_s, channel.values, channel.interpolation, time_s, weights)) weights.clear();
      break;
    }
  }
}

void apply_channel(const LightChannel& channel, float time_s, AnimatedState& state) {
  if (channel.light < 0 || index(channel.light) >= state.lights.size()) return;
  Light& light = state.lights[index(channel.light)];
  const bool is_color = channel.property == LightChannel::Property::kColor;
  const std::span<float> value = is_color ? std::span<float>(&light.color.x, 3) : std::span<float>(&light.intensity, 1);
  if (!sample_keyframes(channel.times_s, channel.values, channel.interpolation, time_s, value)) return;
  for (float& v : value) v = std::max(v, 0.0f);  // a cubic spline may swing below zero; light cannot
}

AnimatedState animate(const Scene& scene, double time_s) {
  AnimatedState state;
  state.locals.reserve(scene.nodes.size());
  for (const Node& node : scene.nodes) state.locals.push_back(node.local);
  state.lights = scene.lights;
  for (const Animation& animation : scene.animations) {
    const float local_s = local_time_s(time_s, animation.duration_s);
    for (const AnimationChannel& channel : animation.channels) apply_channel(channel, local_s, state);
    for (const LightChannel& channel : animation.light_channels) apply_channel(channel, local_s, state);
  }
  return state;
}

glm::mat4 matrix_of(const Transform& t) {
  glm::mat4 matrix = glm::mat4_cast(t.rotation);
  matrix[0] *= t.scale.x;
  matrix[1] *= t.scale.y;
  matrix[2] *= t.scale.z;
  matrix[3] = glm::vec4(t.translation, 1.0f);
  return matrix;
}

/// Nodes in an order in which parents precede their children; nodes that no root leads to are left out.
std::vector<int> parents_first(const Scene& scene) {
  std::vector<int> order;
  order.reserve(scene.nodes.size());
  order.assign(scene.roots.begin(), scene.roots.end());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::vector<int>& children = scene.nodes[index(order[i])].children;
    order.insert(order.end(), children.begin(), children.end());
  }
  return order;
}

std::vector<glm::mat4> multiply_out(const Scene& scene, const std::vector<int>& order,
                                    const std::vector<Transform>& locals) {
  std::vector<glm::mat4> world(scene.nodes.size(), glm::mat4(1.0f));
  for (const int i : order) {
    const Node& node = scene.nodes[index(i)];
    const glm::mat4 local = node.matrix ? *node.matrix : matrix_of(locals[index(i)]);
    world[index(i)] = node.parent == kNone ? local : world[index(node.parent)] * local;
  }
  return world;
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float squared = glm::dot(v, v);
  return squared > 0.0f && std::isfinite(squared) ? v * (1.0f / std::sqrt(squared)) : fallback;
}

/// The rigid placement nearest to `matrix` that keeps its viewing direction and the side that is up.
glm::mat4 without_scale(const glm::mat4& matrix) {
  const glm::vec3 back = unit_or(glm::vec3(matrix[2]), {0.0f, 0.0f, 1.0f});
  const glm::vec3 any_right =
      std::abs(back.y) < 0.9f ? glm::cross({0.0f, 1.0f, 0.0f}, back) : glm::cross({0.0f, 0.0f, -1.0f}, back);
  const glm::vec3 right = unit_or(glm::cross(glm::vec3(matrix[1]), back), glm::normalize(any_right));
  return glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f), glm::vec4(back, 0.0f),
                   glm::vec4(glm::vec3(matrix[3]), 1.0f));
}

/// Places meshes, lights and cameras of nodes one after another.
class PoseBuilder {
 public:
  PoseBuilder(const Scene& scene, const AnimatedState& state, const std::vector<glm::mat4>& world)
      : scene_(scene), state_(state), world_(world) {}

  void add_meshes(int n) {
    const Node& node = scene_.nodes[index(n)];
    if (node.mesh == kNone) return;
    const std::shared_ptr<const Mesh>& mesh = scene_.meshes[index(node.mesh)];
    const std::span<const float> weights = morph_weights(n, *mesh);
    joint_matrices_ = nullptr;  // made by the first primitive that needs them
    for (std::size_t i = 0; i < mesh->primitives.size(); ++i) add_primitive(n, mesh, i, weights);
  }

  void add_light(int n) {
    const Node& node = scene_.nodes[index(n)];
    if (node.light == kNone) return;
    const glm::mat4& world = world_[index(n)];
    pose_.lights.push_back({state_.lights[index(node.light)], glm::vec3(world[3]),
                            unit_or(-glm::vec3(world[2]), {0.0f, 0.0f, -1.0f}), n, node.light});
  }

  void add_camera(int n) {
    const Node& node = scene_.nodes[index(n)];
    if (node.camera == kNone) return;
    pose_.cameras.push_back({scene_.cameras[index(node.camera)], without_scale(world_[index(n)]), n});
  }

  Pose finish() && {
    if (!bounds_.is_empty()) {
      pose_.bounds_min = bounds_.min;
      pose_.bounds_max = bounds_.max;
    }
    return std::move(pose_);
  }

 private:
  std::span<const float> morph_weights(int n, const Mesh& mesh) const {
    if (!state_.weights.empty() && !state_.weights[index(n)].empty()) return state_.weights[index(n)];
    const std::vector<float>& own = scene_.nodes[index(n)].weights;
    return own.empty() ? mesh.weights : own;
  }

  const DeformedShape::JointMatrices& joint_matrices(const Skin& skin) {
    if (joint_matrices_) return joint_matrices_;
    std::vector<glm::mat4> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
      matrices.push_back(j < skin.joint_from_mesh.size() ? world_[index(skin.joints[j])] * skin.joint_from_mesh[j]
                                                         : world_[index(skin.joints[j])]);
    return joint_matrices_ = std::make_shared<const std::vector<glm::mat4>>(std::move(matrices));
  }

  void add_primitive(int n, const std::shared_ptr<const Mesh>& mesh, std::size_t i, std::span<const float> weights) {
    const Primitive& primitive = mesh->primitives[i];
    Instance instance{{mesh, &primitive}, world_[index(n)], primitive.material, n, static_cast<int>(i), nullptr};
    const int skin_index = scene_.nodes[index(n)].skin;
    const bool skinned = skin_index != kNone && !primitive.joints.empty() && !primitive.weights.empty() &&
                         !scene_.skins[index(skin_index)].joints.empty();
    if (skinned || !primitive.morph_targets.empty()) {
      if (skinned) instance.world_from_object = glm::mat4(1.0f);
      instance.deformed = std::make_shared<DeformedShape>(
          instance.primitive, skinned ? joint_matrices(scene_.skins[index(skin_index)]) : nullptr,
          std::vector<float>(weights.begin(), weights.end()));
      const Bounds& bounds = instance.deformed->bounds();
      if (!bounds.is_empty()) bounds_.add_box(instance.world_from_object, bounds.min, bounds.max);
    } else if (!primitive.positions.empty()) {
      bounds_.add_box(instance.world_from_object, primitive.bounds_min, primitive.bounds_max);
    }
    pose_.instances.push_back(std::move(instance));
  }

  const Scene& scene_;
  const AnimatedState& state_;
  const std::vector<glm::mat4>& world_;
  DeformedShape::JointMatrices joint_matrices_;
  Bounds bounds_;
  Pose pose_;
};

/// Per node: neither it nor a node above it is hidden.
std::vector<bool> visible_nodes(const Scene& scene, const std::vector<int>& order) {
  std::vector<bool> visible(scene.nodes.size(), false);
  for (const int i : order) {
    const Node& node = scene.nodes[index(i)];
    visible[index(i)] = node.visible && (node.parent == kNone || visible[index(node.parent)]);
  }
  return visible;
}

}  // namespace

std::vector<glm::mat4> world_from_nodes(const Scene& scene, double time_s) {
  return multiply_out(scene, parents_first(scene), animate(scene, time_s).locals);
}

double animation_duration_s(const Scene& scene) {
  double duration_s = 0.0;
  for (const Animation& animation : scene.animations)
    duration_s = std::max(duration_s, static_cast<double>(animation.duration_s));
  return duration_s;
}

Pose pose_at(const Scene& scene, double time_s) {
  const AnimatedState state = animate(scene, time_s);
  const std::vector<int> order = parents_first(scene);
  const std::vector<glm::mat4> world = multiply_out(scene, order, state.locals);
  const std::vector<bool> visible = visible_nodes(scene, order);

  PoseBuilder builder(scene, state, world);
  for (int n = 0; index(n) < scene.nodes.size(); ++n) {
    builder.add_camera(n);  // a hidden node's camera still counts: hiding a thing must not renumber the cameras
    if (!visible[index(n)]) continue;
    builder.add_meshes(n);
    builder.add_light(n);
  }
  return std::move(builder).finish();
}

}  // namespace lightwell
