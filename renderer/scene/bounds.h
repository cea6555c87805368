// Boxes along the axes: around points, around boxes that are transformed, around what a primitive may be deformed to.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "renderer/scene/scene.h"

namespace lightwell {

/// Empty (min > max) until something is added.
struct Bounds {
  glm::vec3 min{std::numeric_limits<float>::max()}, max{-std::numeric_limits<float>::max()};

  bool is_empty() const { return min.x > max.x; }
  void add(const glm::vec3& point);
  /// The box around the box `low`..`high` after an affine transform.
  void add_box(const glm::mat4& world_from_box, const glm::vec3& low, const glm::vec3& high);
};

Bounds bounds_of(std::span<const glm::vec3> points);

/// Fills in what a primitive knows of its extent: its own bounds, those of its joints' vertices, and how far its morph
/// targets reach. Whoever makes a primitive calls it last.
void fill_bounds(Primitive& primitive);

/// A box that holds the primitive's vertices however few of them the matrices and weights bring to its sides; of a
/// rigid joint's vertices it is exact. Parameters as of morph() and skin(); without matrices it is in the primitive's
/// own space.
Bounds deformed_bounds(const Primitive& primitive, std::span<const glm::mat4> world_from_mesh,
                       std::span<const float> morph_weights);

}  // namespace lightwell
