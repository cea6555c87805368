#include "renderer/scene/builtin/scene_builder.h"

#include <algorithm>
#include <cmath>

namespace lightwell::builtin {

glm::quat look_along(const glm::vec3& direction, const glm::vec3& up) {
  const glm::vec3 back = -glm::normalize(direction);
  const bool parallel = std::abs(glm::dot(back, glm::normalize(up))) > 0.9999f;
  const glm::vec3 right = glm::normalize(glm::cross(parallel ? glm::vec3(0.0f, 0.0f, -1.0f) : up, back));
  return glm::normalize(glm::quat_cast(glm::mat3(right, glm::cross(back, right), back)));
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

int SceneBuilder::emitter(std::string name, const glm::vec3& radiance_nit) {
  const int index = material(std::move(name), glm::vec3(0.0f));
  const float strength = std::max({radiance_nit.r, radiance_nit.g, radiance_nit.b});
  material(index).emissive_factor = radiance_nit / strength;  // glTF keeps the factor within 0..1
  material(index).emissive_strength = strength;
  return index;
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
