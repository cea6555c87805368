#include "renderer/scene/builtin/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lightwell::builtin {

glm::quat look_along(const glm::vec3& direction, const glm::vec3& up) {
  const glm::vec3 back = -glm::normalize(direction);
  const bool parallel = std::abs(glm::dot(back, glm::normalize(up))) > 0.9999f;
  const glm::vec3 right = glm::normalize(glm::cross(parallel ? glm::vec3(0.0f, 0.0f, -1.0f) : up, back));
  return glm::normalize(glm::quat_cast(glm::mat3(right, glm::cross(back, right), back)));
}

namespace {

/// Keys at equal times with the derivatives of `value` as tangents: a cubic spline through a smooth periodic function.
template <int kWidth, class Value>
AnimationChannel smooth_channel(int node, AnimatedProperty property, float duration_s, int keys, const Value& value) {
  AnimationChannel channel{node, property, Interpolation::kCubicSpline, {}, {}, kWidth};
  constexpr float kStep = 1.0f / 512.0f;
  const auto wrapped = [](float phase) { return phase - std::floor(phase); };
  for (int k = 0; k <= keys; ++k) {
    const float phase = wrapped(static_cast<float>(k) / static_cast<float>(keys));
    const auto here = value(phase);
    auto after = value(wrapped(phase + kStep)), before = value(wrapped(phase - kStep));
    float sign = 1.0f;  // a quaternion may return with the other sign: keep to the side of the key before
    if constexpr (kWidth == 4) {
      if (glm::dot(after, here) < 0.0f) after = -after;
      if (glm::dot(before, here) < 0.0f) before = -before;
      if (k > 0) {
        const float* last = &channel.values[channel.values.size() - 8];
        sign = glm::dot(here, glm::quat(last[3], last[0], last[1], last[2])) < 0.0f ? -1.0f : 1.0f;
      }
    }
    const auto tangent = (after - before) * (sign / (2.0f * kStep * duration_s));
    const auto at_key = here * sign;
    channel.times_s.push_back(duration_s * static_cast<float>(k) / static_cast<float>(keys));
    for (const auto& part : {tangent, at_key, tangent})
      for (int i = 0; i < kWidth; ++i) channel.values.push_back(part[i]);
  }
  return channel;
}

}  // namespace

void animate_translation(Animation& animation, int node, int keys, const std::function<glm::vec3(float phase)>& value) {
  animation.channels.push_back(
      smooth_channel<3>(node, AnimatedProperty::kTranslation, animation.duration_s, keys, value));
}

void animate_rotation(Animation& animation, int node, int keys, const std::function<glm::quat(float phase)>& value) {
  animation.channels.push_back(smooth_channel<4>(node, AnimatedProperty::kRotation, animation.duration_s, keys, value));
}

void animate_spin(Animation& animation, int node, const glm::vec3& axis, int turns, const glm::quat& first) {
  AnimationChannel channel{node, AnimatedProperty::kRotation, Interpolation::kLinear, {}, {}, 4};
  const int quarters = 4 * std::abs(turns);
  for (int k = 0; k <= quarters; ++k) {
    const float angle = glm::half_pi<float>() * static_cast<float>(turns < 0 ? -k : k);
    const glm::quat q = first * glm::angleAxis(angle, axis);
    channel.times_s.push_back(animation.duration_s * static_cast<float>(k) / static_cast<float>(quarters));
    channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
  }
  animation.channels.push_back(std::move(channel));
}

int SceneBuilder::material(std::string name, const glm::vec3& albedo, float roughness, float metallic) {
  Material material;
  material.name = std::move(name);
  material.base_color_factor = glm::vec4(albedo, 1.0f);
  material.roughness_factor = roughness;
  material.metallic_factor = metallic;
  scene_.materials.push_back(std::move(material));
  return static_cast<int>(scene_.materials.size()) - 1;
}

int SceneBuilder::material(std::string name, Image picture, float width_m, float roughness) {
  const int index = material(std::move(name), glm::vec3(1.0f), roughness);
  scene_.images.push_back(std::make_shared<const Image>(std::move(picture)));
  scene_.textures.push_back({scene_.images.back()->name, static_cast<int>(scene_.images.size()) - 1, {}});
  TextureUse& use = material(index).base_color_texture;
  use.texture = static_cast<int>(scene_.textures.size()) - 1;
  use.scale = glm::vec2(1.0f / width_m);
  return index;
}

int SceneBuilder::emitter(std::string name, const glm::vec3& radiance_nit) {
  const int index = material(std::move(name), glm::vec3(0.0f));
  const float strength = std::max({radiance_nit.r, radiance_nit.g, radiance_nit.b});
  material(index).emissive_factor = radiance_nit / strength;  // glTF keeps the factor within 0..1
  material(index).emissive_strength = strength;
  return index;
}

Animation& SceneBuilder::animation(std::string name, float duration_s) {
  scene_.animations.push_back({std::move(name), {}, {}, duration_s});
  return scene_.animations.back();
}

int SceneBuilder::mesh(std::string name, std::initializer_list<Part> parts) {
  auto mesh = std::make_shared<Mesh>();
  mesh->name = std::move(name);
  for (const Part& part : parts) mesh->primitives.push_back(part.triangles.finish(part.material));
  scene_.meshes.push_back(std::move(mesh));
  return static_cast<int>(scene_.meshes.size()) - 1;
}

int SceneBuilder::node(std::string name, const Transform& local, int parent) {
  const int index = static_cast<int>(scene_.nodes.size());
  Node node;
  node.name = std::move(name);
  node.parent = parent;
  node.local = local;
  scene_.nodes.push_back(std::move(node));
  (parent < 0 ? scene_.roots : scene_.nodes[static_cast<std::size_t>(parent)].children).push_back(index);
  return index;
}

int SceneBuilder::mesh_node(std::string name, int mesh, const Transform& local, int parent) {
  const int index = node(std::move(name), local, parent);
  scene_.nodes.back().mesh = mesh;
  return index;
}

int SceneBuilder::mesh_node(std::string name, std::initializer_list<Part> parts, const Transform& local, int parent) {
  const int index = mesh(name, parts);
  return mesh_node(std::move(name), index, local, parent);
}

int SceneBuilder::light_node(const Light& light, const Transform& local, int parent) {
  scene_.lights.push_back(light);
  const int index = node(light.name, local, parent);
  scene_.nodes.back().light = static_cast<int>(scene_.lights.size()) - 1;
  return index;
}

int SceneBuilder::camera_node(std::string name, const glm::vec3& eye, const glm::vec3& target, float yfov, int parent) {
  Camera camera;
  camera.name = name;
  camera.yfov = yfov;
  scene_.cameras.push_back(std::move(camera));
  const int index = node(std::move(name), {eye, look_along(target - eye), glm::vec3(1.0f)}, parent);
  scene_.nodes.back().camera = static_cast<int>(scene_.cameras.size()) - 1;
  return index;
}

}  // namespace lightwell::builtin
