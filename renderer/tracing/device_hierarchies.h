// What the compute tracer's shader reads: hierarchies and triangles of all geometry in shared buffers, and the top
// level over this frame's groups. Built on the CPU; a frame in which nothing changed uploads nothing.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "renderer/tracing/bvh.h"
#include "renderer/tracing/coverage.h"
#include "renderer/tracing/device_pool.h"
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

/// std430, 64 bytes; `coverage_words` in coverage.glsl.
struct DeviceCoverage {
  std::uint32_t outcome, min_texel, blend_factor, wraps;         // wraps: s | t << 8
  std::uint32_t first_texel, width_px, height_px, first_corner;  // width 0: no image
  glm::vec4 u_row, v_row;                                        // w is unused
};
static_assert(sizeof(DeviceCoverage) == 64);

/// std430, 8 bytes; `instances` in candidates.comp. How to find an instance's triangles by their number.
struct DeviceInstance {
  std::uint32_t group;        // in the group buffer
  std::uint32_t first_place;  // of its first triangle
};
static_assert(sizeof(DeviceInstance) == 8);

class DeviceHierarchies {
 public:
  DeviceHierarchies();

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

  bool needs_coverage() const { return needs_coverage_; }
  std::uint64_t memory_bytes() const;

 private:
  struct BottomLevel {
    std::vector<std::shared_ptr<const Primitive>> primitives;  // keep the key's addresses alive
    std::shared_ptr<const DeformedShape> shape;
    PoolRange nodes, triangles, places;
    std::uint32_t root = 0;  // in the node buffer
    Box bounds;              // in the group's space
    Bvh bvh;                 // kept for refitting; empty if rigid
    float built_cost = 0.0f;
    std::uint64_t last_used = 0;
  };
  struct CornerUvs {
    std::shared_ptr<const Primitive> primitive;
    PoolRange range;
    std::uint64_t last_used = 0;
  };
  struct AlphaPlane {
    std::shared_ptr<const Image> image;
    PoolRange words;
    std::uint64_t last_used = 0;
  };

  const BottomLevel& bottom_level(const GeometryGroup& group, std::span<const Instance> instances);
  void build(BottomLevel& level, const GeometryGroup& group, std::span<const Instance> instances);
  void refit(BottomLevel& level, const GeometryGroup& group);
  std::vector<DeviceInstance> find_instances(const std::vector<GeometryGroup>& groups,
                                             const std::vector<const BottomLevel*>& levels,
                                             const std::vector<std::uint32_t>& order, std::size_t count) const;
  void upload(const BottomLevel& level, const Bvh& bvh, const GeometryGroup& group);
  void build_top_level(const std::vector<GeometryGroup>& groups, const std::vector<const BottomLevel*>& levels,
                       std::size_t instance_count);
  void update_coverage(const TraceScene& scene, std::vector<bool>& filtered);
  DeviceCoverage device_coverage(const CoverageTest& test, const TraceScene& scene, std::size_t instance);
  std::uint32_t first_corner(const std::shared_ptr<const Primitive>& primitive, int uv_set);
  std::uint32_t first_texel(const std::shared_ptr<const Image>& image);
  void drop_unused();

  ThreadPool threads_;
  DevicePool nodes_, triangles_, places_, corner_uvs_, alpha_;
  std::map<GeometryKey, std::unique_ptr<BottomLevel>> bottom_levels_;
  std::map<std::pair<const Primitive*, int>, CornerUvs> corners_;  // by uv set as well
  std::unordered_map<const Image*, AlphaPlane> planes_;
  AlphaRanges alpha_ranges_;

  gl::Buffer group_buffer_, coverage_buffer_, instance_buffer_;
  std::vector<DeviceGroup> groups_;  // as they stand in the buffer
  std::vector<DeviceCoverage> coverage_;
  std::vector<DeviceInstance> instances_;
  std::vector<BvhNode> top_nodes_;
  PoolRange top_range_;
  std::uint32_t top_root_ = kNothing;
  bool needs_coverage_ = false;
  std::uint64_t frame_ = 0;
};

}  // namespace lightwell
