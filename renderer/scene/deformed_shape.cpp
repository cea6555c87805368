#include "renderer/scene/deformed_shape.h"

#include <algorithm>

#include "renderer/scene/deform.h"

namespace lightwell {

DeformedShape::DeformedShape(std::shared_ptr<const Primitive> primitive, JointMatrices world_from_mesh,
                             std::vector<float> morph_weights)
    : primitive_(std::move(primitive)),
      world_from_mesh_(std::move(world_from_mesh)),
      morph_weights_(std::move(morph_weights)),
      bounds_(deformed_bounds(*primitive_, this->world_from_mesh(), morph_weights_)) {}

DeformedShape::DeformedShape(std::vector<glm::vec3> positions) : bounds_(bounds_of(positions)) {
  std::call_once(made_, [&] { positions_ = std::move(positions); });
}

std::size_t DeformedShape::vertex_count() const {
  return primitive_ ? primitive_->positions.size() : positions_.size();
}

std::span<const glm::mat4> DeformedShape::world_from_mesh() const {
  return world_from_mesh_ ? std::span<const glm::mat4>(*world_from_mesh_) : std::span<const glm::mat4>();
}

bool DeformedShape::same_as(const DeformedShape& other) const {
  if (this == &other) return true;
  return primitive_ && primitive_ == other.primitive_ && std::ranges::equal(morph_weights_, other.morph_weights_) &&
         std::ranges::equal(world_from_mesh(), other.world_from_mesh());
}

std::span<const glm::vec3> DeformedShape::positions() const {
  std::call_once(made_, [this] { positions_ = vertices().positions; });
  return positions_;
}

void DeformedShape::take_positions(std::span<const glm::vec3> positions) const {
  std::call_once(made_, [&] { positions_.assign(positions.begin(), positions.end()); });
}

DeformedVertices DeformedShape::vertices() const {
  if (!primitive_) return {positions_, {}, {}};
  DeformedVertices vertices = morph(*primitive_, morph_weights_);
  skin(*primitive_, world_from_mesh(), vertices);
  return vertices;
}

std::span<const glm::vec3> positions_of(const Primitive& primitive, const DeformedShape* deformed) {
  return deformed ? deformed->positions() : std::span<const glm::vec3>(primitive.positions);
}

bool same_shape(const std::shared_ptr<const DeformedShape>& a, const std::shared_ptr<const DeformedShape>& b) {
  return a == b || (a && b && a->same_as(*b));
}

}  // namespace lightwell
