#include "renderer/tracing/geometry_groups.h"

#include <cmath>

#include "renderer/check.h"

namespace lightwell {
namespace {

bool is_finite(const glm::mat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

// The determinant against the lengths of the axes, so that a small object is not taken for a flat one.
bool is_invertible(const glm::mat4& m) {
  const glm::dmat3 axes{glm::mat3(m)};
  const double volume = std::abs(glm::determinant(axes));
  const double box = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
  if (!(volume > 1e-6 * box)) return false;
  return is_finite(glm::inverse(m));
}

std::shared_ptr<const DeformedShape> in_world_space(const Instance& instance) {
  std::vector<glm::vec3> placed;
  for (const glm::vec3& p : positions_of(instance))
    placed.push_back(glm::vec3(instance.world_from_object * glm::vec4(p, 1.0f)));
  return std::make_shared<DeformedShape>(std::move(placed));
}

GeometryGroup group_of(const Instance& instance, std::uint32_t index, bool filtered) {
  GeometryGroup group;
  group.key.primitives = {instance.primitive.get()};
  group.key.filtered = filtered;
  group.first_instance = index;
  if (is_invertible(instance.world_from_object)) {
    group.world_from_object = instance.world_from_object;
    group.deformed = instance.deformed;
  } else {
    group.deformed = in_world_space(instance);
  }
  if (group.deformed) {
    LIGHTWELL_CHECK_OP(group.deformed->vertex_count(), ==, instance.primitive->positions.size());
    group.key.node = instance.node;
    group.key.primitive_index = instance.primitive_index;
  }
  return group;
}

bool joins(const Instance& instance, std::uint32_t index, bool filtered, const GeometryGroup& group,
           const Instance& first) {
  return !instance.deformed && !group.deformed && instance.node == first.node && instance.node >= 0 &&
         group.first_instance + group.key.primitives.size() == index && group.key.filtered == filtered &&
         instance.world_from_object == group.world_from_object;
}

}  // namespace

std::vector<GeometryGroup> group_instances(std::span<const Instance> instances, const std::vector<bool>& filtered) {
  std::vector<GeometryGroup> groups;
  groups.reserve(instances.size());
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const Instance& instance = instances[i];
    if (instance.primitive->indices.size() < 3 || !is_finite(instance.world_from_object)) continue;
    if (!groups.empty() && joins(instance, i, filtered[i], groups.back(), instances[groups.back().first_instance]))
      groups.back().key.primitives.push_back(instance.primitive.get());
    else
      groups.push_back(group_of(instance, i, filtered[i]));
  }
  return groups;
}

}  // namespace lightwell
