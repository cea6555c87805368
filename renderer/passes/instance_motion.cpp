#include "renderer/passes/instance_motion.h"

#include <algorithm>

#include "renderer/passes/bindings.glsl"
#include "renderer/passes/device_types.h"

namespace lightwell {

bool InstanceMotion::Placed::same_as(const Instance& instance) const {
  return node == instance.node && primitive_index == instance.primitive_index && primitive == instance.primitive;
}

// Most scenes keep the order of their instances from frame to frame.
const InstanceMotion::Placed* InstanceMotion::before(const Instance& instance, std::size_t index) const {
  if (index < before_.size() && before_[index].same_as(instance)) return &before_[index];
  const auto found =
      std::find_if(before_.begin(), before_.end(), [&](const Placed& placed) { return placed.same_as(instance); });
  return found != before_.end() ? &*found : nullptr;
}

void InstanceMotion::follow(const Pose& pose, const DevicePositions& positions) {
  std::swap(positions_, next_positions_);
  upload(pose);
  before_.clear();
  std::uint32_t kept = 0;
  for (const Instance& instance : pose.instances) {
    before_.push_back({instance.node, instance.primitive_index, instance.primitive, instance.world_from_object,
                       instance.deformed, kept});
    if (instance.deformed) kept += static_cast<std::uint32_t>(instance.deformed->vertex_count());
  }
  if (kept > 0) keep(positions, kept);
}

// Others' frames come between this one and the view's next, so that positions are copied.
void InstanceMotion::keep(const DevicePositions& positions, std::uint32_t count) {
  next_positions_.reserve(count * sizeof(glm::vec3));
  for (std::size_t i = 0; i < before_.size(); ++i) {
    const Placed& placed = before_[i];
    if (!placed.deformed) continue;
    glCopyNamedBufferSubData(positions.buffer->id(), next_positions_.id(),
                             static_cast<GLintptr>(positions.first[i] * sizeof(glm::vec3)),
                             static_cast<GLintptr>(placed.first_position * sizeof(glm::vec3)),
                             static_cast<GLsizeiptr>(placed.deformed->vertex_count() * sizeof(glm::vec3)));
  }
}

void InstanceMotion::upload(const Pose& pose) {
  moving_ = deforming_ = false;
  std::vector<DeviceInstanceBefore> packed;
  packed.reserve(pose.instances.size());
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    const Instance& instance = pose.instances[i];
    const Placed* placed = before(instance, i);
    packed.push_back(pack_instance_before(placed ? placed->world_from_object : instance.world_from_object));
    if (!placed) continue;
    const bool deforms = instance.deformed && placed->deformed && !same_shape(instance.deformed, placed->deformed);
    moving_ = moving_ || deforms || placed->world_from_object != instance.world_from_object;
    if (!deforms) continue;
    deforming_ = true;
    packed.back().first_position = placed->first_position;
  }
  if (!moving_) return;
  instances_.reserve(packed.size() * sizeof(DeviceInstanceBefore));
  instances_.upload(std::span<const DeviceInstanceBefore>(packed));
  instance_texels_.attach(instances_);
  if (deforming_) position_texels_.attach(positions_);
}

void InstanceMotion::bind() const {
  if (moving_) instance_texels_.bind(UNIT_INSTANCES_BEFORE);
  if (deforming_) position_texels_.bind(UNIT_POSITIONS_BEFORE);
}

}  // namespace lightwell
