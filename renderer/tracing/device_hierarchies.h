// What the compute tracer's shader reads: hierarchies and triangles of all geometry in shared buffers, and the top
// level over this frame's groups. Built on the CPU; a frame in which nothing changed uploads nothing.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/tracing/bvh.h"
#include "renderer/tracing/device_coverage.h"
#include "renderer/tracing/device_pool.h"
#include "renderer/tracing/device_refit.h"
#include "renderer/tracing/geometry_groups.h"
#include "renderer/tracing/thread_pool.h"

namespace lightwell {

/// std430, 64 bytes; `group_words` in trace.comp.
struct DeviceGroup {
  glm::vec4 object_from_world[3];  // rows
  std::uint32_t root;              // BvhChild in the node buffer
  std::uint32_t first_instance;
  std::uint32_t triangles;  // their count, and kNeedsCoverage
  std::uint32_t first_triangle;
  static constexpr std::uint32_t kNeedsCoverage = 1u << 31;
};
static_assert(sizeof(DeviceGroup) == 64);

/// std430, 8 bytes; `instances` in candidates.comp. How to find an instance's triangles by their number.
struct DeviceInstance {
  std::uint32_t group;        // in the group buffer
  std::uint32_t first_place;  // of its first triangle
};
static_assert(sizeof(DeviceInstance) == 8);

class DeviceHierarchies {
 public:
  explicit DeviceHierarchies(gl::ShaderLibrary& shaders);

  /// As Tracer::update. Throws std::runtime_error if the device cannot hold the scene.
  void update(const TraceScene& scene);

  /// Binds everything but rays and results.
  void bind() const;

  /// Binds as well what finds triangles by instance and number.
  void bind_places() const;

  /// A BvhChild, or kNothing if there is no triangle.
  std::uint32_t top_root() const { return top_root_; }
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  /// In the group buffer.
  std::uint32_t group_count() const { return static_cast<std::uint32_t>(groups_.size()); }

  bool needs_coverage() const { return coverage_.are_needed(); }
  std::uint64_t memory_bytes() const;

 private:
  struct BottomLevel {
    std::vector<std::shared_ptr<const Primitive>> primitives;  // keep the key's addresses alive
    std::shared_ptr<const DeformedShape> shape;
    PoolRange nodes, triangles, places;
    std::uint32_t root = 0;  // in the node buffer
    Box bounds;              // in the group's space
    float built_cost = 0.0f;
    std::optional<Bvh> bvh;                 // kept for refitting by the processor
    std::optional<DeviceRefit::Plan> plan;  // for refitting on the device, where that has the positions
    std::uint64_t last_used = 0;
  };
  const BottomLevel& bottom_level(const GeometryGroup& group, const TraceScene& scene);
  void build(BottomLevel& level, const GeometryGroup& group, const TraceScene& scene);
  void refit(BottomLevel& level, const GeometryGroup& group, const TraceScene& scene);
  void refit_by_processor(BottomLevel& level, const GeometryGroup& group);
  void refit_on_device(BottomLevel& level, const GeometryGroup& group, const TraceScene& scene);
  std::vector<DeviceInstance> find_instances(const std::vector<GeometryGroup>& groups,
                                             const std::vector<const BottomLevel*>& levels,
                                             const std::vector<std::uint32_t>& order, std::size_t count) const;
  void upload(const BottomLevel& level, const Bvh& bvh, const GeometryGroup& group);
  void build_top_level(const std::vector<GeometryGroup>& groups, const std::vector<const BottomLevel*>& levels,
                       std::size_t instance_count);
  void drop_unused();

  ThreadPool threads_;
  DevicePool nodes_, triangles_, places_;
  DeviceCoverageTests coverage_;
  gl::ShaderLibrary& shaders_;
  std::optional<DeviceRefit> device_refit_;  // made when something deforms
  std::map<GeometryKey, std::unique_ptr<BottomLevel>> bottom_levels_;

  gl::Buffer group_buffer_, instance_buffer_;
  std::vector<DeviceGroup> groups_;  // as they stand in the buffer
  std::vector<DeviceInstance> instances_;
  std::vector<BvhNode> top_nodes_;
  PoolRange top_range_;
  std::uint32_t top_root_ = kNothing;
  std::uint64_t frame_ = 0;
};

}  // namespace lightwell
