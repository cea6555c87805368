// Which bottom-level hierarchies a frame needs. Instances that can never move against each other (the primitives of one
// node) share one, so that a mesh of many overlapping primitives is one well-sorted hierarchy and not many mixed ones.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "renderer/tracing/tracer.h"

namespace lightwell {

/// Names a bottom-level hierarchy over the frames.
struct GeometryKey {
  std::vector<const Primitive*> primitives;
  int node = -1, primitive_index = -1;  // of deformed geometry; -1 if rigid: nodes with the same mesh share it
  bool filtered = false;                // some of its hits need a coverage test
  auto operator<=>(const GeometryKey&) const = default;
};

/// Consecutive instances under one matrix. Instance `first_instance + i` shows `key.primitives[i]`.
struct GeometryGroup {
  GeometryKey key;
  std::uint32_t first_instance = 0;
  glm::mat4 world_from_object{1.0f};              // finite and invertible
  std::shared_ptr<const DeformedShape> deformed;  // not null: a group of one
};

/// All triangles of a group in its own space, primitive by primitive: body(primitive of the group, triangle, corners).
template <class Body>
void for_triangles(const GeometryGroup& group, const Body& body) {
  for (std::uint32_t p = 0; p < group.key.primitives.size(); ++p) {
    const Primitive& primitive = *group.key.primitives[p];
    const std::span<const glm::vec3> positions = positions_of(primitive, group.deformed.get());
    for (std::uint32_t t = 0; t < primitive.indices.size() / 3; ++t) {
      const std::uint32_t* corners = &primitive.indices[std::size_t{3} * t];
      body(p, t, std::array<glm::vec3, 3>{positions[corners[0]], positions[corners[1]], positions[corners[2]]});
    }
  }
}

/// Groups the instances in their order. `filtered[i]`: hits of instance i need a coverage test. Instances without a
/// triangle or with a matrix that is not finite are left out. One that is flattened by its matrix becomes a deformed
/// one in world space, since it has no inverse to take rays into its own space.
std::vector<GeometryGroup> group_instances(std::span<const Instance> instances, const std::vector<bool>& filtered);

}  // namespace lightwell
