// Skins and morph targets on the device: from what stands still, this frame's matrices and weights to the vertices and
// triangles that everything draws and traces.
#pragma once

#include <vector>

#include "renderer/gl/program.h"
#include "renderer/passes/device_geometry.h"

namespace lightwell {

class Deformer {
 public:
  explicit Deformer(gl::ShaderLibrary& shaders);

  /// Makes what the tasks ask for, which must have room there, unless it is there already. UNIT_POSITIONS, _VERTICES
  /// and _TRIANGLES must read the geometry's. The shapes get their positions, too, if those are host-visible; then this
  /// waits for the device.
  void run(const std::vector<DeformTask>& tasks, DeviceGeometry& geometry);

 private:
  // std430, 48 bytes; `Task` in deform_task.glsl.
  struct DeviceTask {
    std::uint32_t first_group;  // of the dispatch
    std::uint32_t count;        // vertices, or triangles
    std::uint32_t first_source, first_target;
    std::uint32_t source_vertex, target_vertex;  // the first ones, for triangles
    std::uint32_t first_influence, first_matrix, last_joint;
    std::uint32_t first_morph, morphs;
    std::uint32_t padding;
  };
  static_assert(sizeof(DeviceTask) == 48);
  // std430, 16 bytes: a morph target that has a weight.
  struct DeviceMorph {
    std::uint32_t first_position, first_normal, first_tangent;
    float weight;
  };
  // The tasks of a dispatch, and which of them each of its work groups belongs to.
  struct Dispatch {
    std::vector<DeviceTask> tasks;
    std::vector<std::uint32_t> groups;
    void add(DeviceTask task);
  };

  void deform(const std::vector<DeformTask>& tasks, const DeviceGeometry& geometry);
  void prepare(const std::vector<DeformTask>& tasks, const DeviceGeometry& geometry);
  void dispatch(const gl::ProgramPtr& program, const Dispatch& dispatch);

  gl::ProgramPtr vertices_program_, triangles_program_;
  Dispatch vertices_, triangles_;
  std::vector<glm::vec4> matrix_rows_;  // three of each joint
  std::vector<DeviceMorph> morphs_;
  gl::Buffer task_buffer_{"deformations", 0}, group_buffer_{"groups of deformations", 0};
  gl::Buffer matrix_buffer_{"joint matrices", 0}, morph_buffer_{"weights of morph targets", 0};
  gl::BufferTexture matrix_texels_{"joint matrices", GL_RGBA32F};
};

}  // namespace lightwell
