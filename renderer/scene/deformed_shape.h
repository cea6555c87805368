// What a skinned or morphed primitive looks like at one moment: the matrices and weights that the device makes its
// vertices from, and its positions for what works on the processor.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "renderer/scene/bounds.h"

namespace lightwell {

/// Vertices of a skinned or morphed primitive. World space if skinned, else the node's.
struct DeformedVertices {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec4> tangents;
};

class DeformedShape {
 public:
  using JointMatrices = std::shared_ptr<const std::vector<glm::mat4>>;

  /// `world_from_mesh`: of the joints, see skin(); null where there is no skin. `morph_weights`: see morph().
  DeformedShape(std::shared_ptr<const Primitive> primitive, JointMatrices world_from_mesh,
                std::vector<float> morph_weights);
  /// One of which only positions are known: no device can make it.
  explicit DeformedShape(std::vector<glm::vec3> positions);

  /// Known by its positions alone.
  bool is_given() const { return primitive_ == nullptr; }
  std::size_t vertex_count() const;
  std::span<const glm::mat4> world_from_mesh() const;  // empty: no skin
  std::span<const float> morph_weights() const { return morph_weights_; }
  /// Holds all vertices, in their space.
  const Bounds& bounds() const { return bounds_; }
  /// Made from equal matrices and weights. Shapes that are known by their positions are equal to themselves alone.
  bool same_as(const DeformedShape& other) const;

  /// Those that take_positions() brought, or the processor's own, made by the first caller. Safe on any thread.
  std::span<const glm::vec3> positions() const;
  /// Positions that the device has made, before anyone asks for them; later ones are ignored.
  void take_positions(std::span<const glm::vec3> positions) const;
  /// All of the vertices, made by the processor.
  DeformedVertices vertices() const;

 private:
  std::shared_ptr<const Primitive> primitive_;
  JointMatrices world_from_mesh_;
  std::vector<float> morph_weights_;
  Bounds bounds_;
  mutable std::once_flag made_;
  mutable std::vector<glm::vec3> positions_;
};

/// Of a primitive's vertices, on the processor; `deformed`: null if it is rigid.
std::span<const glm::vec3> positions_of(const Primitive& primitive, const DeformedShape* deformed);

/// Whether two instances have the same shape; a rigid one has none.
bool same_shape(const std::shared_ptr<const DeformedShape>& a, const std::shared_ptr<const DeformedShape>& b);

}  // namespace lightwell
