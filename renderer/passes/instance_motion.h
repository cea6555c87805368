// Where a view's instances were in its frame before: what the G-buffer's motion variant draws displacements with.
#pragma once

#include <memory>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/scene/pose.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

class InstanceMotion {
 public:
  /// Takes `pose` as this frame's; of the last call's are the places before. What was not there is taken to have stood
  /// still. `positions`: of the pose's instances, as they are now.
  void follow(const Pose& pose, const DevicePositions& positions);

  /// Whether any instance lies or is shaped differently from the frame before; the rest is of use only then.
  bool moving() const { return moving_; }
  /// Some of them are deformed: vertices have places of their own (DEFORMED_MOTION).
  bool deforming() const { return deforming_; }
  /// A DeviceInstanceBefore for each instance, in the pose's order.
  const gl::Buffer& instances() const { return instances_; }
  /// The places of deformed vertices, for the G-buffer's shaders, and the instances for the traced one's.
  void bind() const;

 private:
  struct Placed {
    int node, primitive_index;
    std::shared_ptr<const Primitive> primitive;
    glm::mat4 world_from_object;
    std::shared_ptr<const DeformedShape> deformed;
    std::uint32_t first_position;  // of the deformed ones that were kept
    bool same_as(const Instance& instance) const;
  };
  const Placed* before(const Instance& instance, std::size_t index) const;
  void upload(const Pose& pose);
  void keep(const DevicePositions& positions, std::uint32_t count);

  std::vector<Placed> before_;
  bool moving_ = false, deforming_ = false;
  gl::Buffer instances_{"instances before", 0};
  gl::Buffer positions_{"deformed positions before", 0}, next_positions_{"deformed positions", 0};
  gl::BufferTexture position_texels_{"deformed positions before", GL_RGB32F};
  gl::BufferTexture instance_texels_{"instances before", GL_RGBA32UI};
};

}  // namespace lightwell
