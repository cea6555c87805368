#include "renderer/scene/bounds.h"

#include <algorithm>
#include <map>

namespace lightwell {

void Bounds::add(const glm::vec3& point) {
  min = glm::min(min, point);
  max = glm::max(max, point);
}

void Bounds::add_box(const glm::mat4& world_from_box, const glm::vec3& low, const glm::vec3& high) {
  const glm::vec3 center = glm::vec3(world_from_box * glm::vec4(0.5f * (low + high), 1.0f));
  const glm::vec3 half = 0.5f * (high - low);
  const glm::vec3 reach = glm::abs(glm::vec3(world_from_box[0])) * half.x +
                          glm::abs(glm::vec3(world_from_box[1])) * half.y +
                          glm::abs(glm::vec3(world_from_box[2])) * half.z;
  add(center - reach);
  add(center + reach);
}

Bounds bounds_of(std::span<const glm::vec3> points) {
  Bounds bounds;
  for (const glm::vec3& point : points) bounds.add(point);
  return bounds;
}

void fill_bounds(Primitive& primitive) {
  if (primitive.positions.empty()) return;
  const Bounds own = bounds_of(primitive.positions);
  primitive.bounds_min = own.min;
  primitive.bounds_max = own.max;

  std::map<std::uint32_t, Bounds> of_joints;
  const std::size_t skinned = std::min({primitive.positions.size(), primitive.joints.size(), primitive.weights.size()});
  for (std::size_t i = 0; i < skinned; ++i)
    for (int k = 0; k < 4; ++k)
      if (primitive.weights[i][k] != 0.0f) of_joints[primitive.joints[i][k]].add(primitive.positions[i]);
  primitive.joint_bounds.clear();
  for (const auto& [joint, bounds] : of_joints) primitive.joint_bounds.push_back({joint, bounds.min, bounds.max});

  for (MorphTarget& target : primitive.morph_targets) {
    if (target.positions.empty()) continue;
    const Bounds displacements = bounds_of(target.positions);
    target.displacement_min = displacements.min;
    target.displacement_max = displacements.max;
  }
}

Bounds deformed_bounds(const Primitive& primitive, std::span<const glm::mat4> world_from_mesh,
                       std::span<const float> morph_weights) {
  glm::vec3 least(0.0f), most(0.0f);
  for (std::size_t i = 0; i < std::min(morph_weights.size(), primitive.morph_targets.size()); ++i) {
    const glm::vec3 a = morph_weights[i] * primitive.morph_targets[i].displacement_min;
    const glm::vec3 b = morph_weights[i] * primitive.morph_targets[i].displacement_max;
    least += glm::min(a, b);
    most += glm::max(a, b);
  }
  Bounds bounds;
  if (world_from_mesh.empty()) {
    bounds.add(primitive.bounds_min + least);
    bounds.add(primitive.bounds_max + most);
  }
  for (std::size_t i = 0; i < primitive.joint_bounds.size() && !world_from_mesh.empty(); ++i) {
    const JointBounds& joint = primitive.joint_bounds[i];
    const std::size_t matrix = std::min<std::size_t>(joint.joint, world_from_mesh.size() - 1);
    bounds.add_box(world_from_mesh[matrix], joint.min + least, joint.max + most);
  }
  return bounds;
}

}  // namespace lightwell
