#include "renderer/passes/photon_targets.h"

#include <array>
#include <cmath>
#include <random>

namespace lightwell {

namespace {

constexpr float kSmooth = 0.5f;  // roughness up to which reflections are images

PhotonTarget target_on(const Instance& instance, std::size_t triangle, glm::vec2 u) {
  const Primitive& primitive = *instance.primitive;
  const std::span<const glm::vec3> positions = positions_of(instance);
  std::array<glm::vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] =
        glm::vec3(instance.world_from_object * glm::vec4(positions[primitive.indices[3 * triangle + k]], 1.0f));
  const glm::vec3 edge_u = corners[1] - corners[0], edge_v = corners[2] - corners[0];
  const glm::vec3 across = glm::cross(edge_u, edge_v);
  const float doubled_m2 = glm::length(across);
  const float root = std::sqrt(u.x);
  PhotonTarget target;
  target.position_ws = corners[0] + root * (1.0f - u.y) * edge_u + root * u.y * edge_v;
  if (!(doubled_m2 > 0.0f) || !std::isfinite(doubled_m2)) return target;
  target.area_m2 = 0.5f * doubled_m2;
  target.normal_ws = across / doubled_m2;
  return target;
}

}  // namespace

bool throws_caustics(const Material& material) {
  const bool smooth = material.roughness_factor <= kSmooth || material.metallic_roughness_texture.texture >= 0;
  return material.metallic_factor > 0.5f && smooth && !material.unlit;
}

std::vector<PhotonTarget> photon_targets(const Scene& scene, const Pose& pose, std::uint32_t count,
                                         std::uint32_t seed) {
  std::vector<const Instance*> instances;
  for (const Instance& instance : pose.instances)
    if (instance.material >= 0 && !instance.primitive->indices.empty() &&
        throws_caustics(scene.materials[static_cast<std::size_t>(instance.material)]))
      instances.push_back(&instance);
  std::vector<PhotonTarget> targets;
  if (instances.empty()) return targets;
  targets.reserve(count);
  std::mt19937 random(seed);
  const auto below = [&random](std::size_t most) { return static_cast<std::size_t>(random()) % most; };
  const auto unit = [&random] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Instance& instance = *instances[i % instances.size()];
    const std::size_t triangles = instance.primitive->indices.size() / 3;
    const std::size_t triangle = below(triangles);
    const float u = unit();
    PhotonTarget target = target_on(instance, triangle, {u, unit()});
    target.area_m2 *= static_cast<float>(triangles) * static_cast<float>(instances.size()) / static_cast<float>(count);
    targets.push_back(target);
  }
  return targets;
}

}  // namespace lightwell
