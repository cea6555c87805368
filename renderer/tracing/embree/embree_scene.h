// The hierarchies of the Embree tracer: one per geometry group, kept over the frames, and the top level over them.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "renderer/tracing/coverage.h"
#include "renderer/tracing/embree/embree_handles.h"
#include "renderer/tracing/geometry_groups.h"
#include "renderer/tracing/thread_pool.h"

namespace lightwell {

class EmbreeScene {
 public:
  /// `threads` for building; 0: one per core. Throws std::runtime_error if Embree cannot start.
  explicit EmbreeScene(unsigned threads);

  /// As Tracer::update, with `threads` for what deforms. Throws std::runtime_error if memory runs out.
  void update(const TraceScene& scene, ThreadPool& threads);

  /// The top level. Rays are traced with an EmbreeContext.
  RTCScene top_level() const { return top_level_.get(); }

  /// The instance in Pose::instances behind Embree's two numbers.
  std::uint32_t instance_of(std::uint32_t top_level_id, std::uint32_t geometry_id) const {
    return first_instances_[top_level_id] + geometry_id;
  }

  /// Whether the triangle counts at these barycentrics.
  bool is_covered(std::uint32_t instance, std::uint32_t triangle, float u, float v) const {
    return lightwell::is_covered(coverage_[instance], *primitives_[instance], instance, triangle, u, v);
  }

  /// Whether some points of its triangles do not count.
  bool needs_coverage(std::uint32_t instance) const {
    return coverage_[instance].outcome != CoverageTest::Outcome::kAlwaysHit;
  }

  /// Coverage::double_sided.
  bool is_double_sided(std::uint32_t instance) const { return double_sided_[instance]; }

  /// Embree's normal of a hit, from the space of an instance of the top level to the world. Its length is meaningless.
  glm::vec3 normal_ws(std::uint32_t top_level_id, glm::vec3 normal) const {
    return slots_[top_level_id].normal_from_object * normal;
  }

  /// The corners of a triangle in the world.
  std::array<glm::vec3, 3> corners_ws(std::uint32_t instance, std::uint32_t triangle) const {
    const Placed& placed = placed_[instance];
    const std::uint32_t* corner = placed.indices + std::size_t{3} * triangle;
    const auto in_world = [&](std::uint32_t vertex) {
      return glm::vec3(placed.world_from_object * glm::vec4(placed.positions[vertex], 1.0f));
    };
    return {in_world(corner[0]), in_world(corner[1]), in_world(corner[2])};
  }

  /// About the size of a triangle, if all were alike and lay as a sheet across the bounds of everything.
  float triangle_size_m() const { return triangle_size_m_; }

  RTCDevice device() const { return device_.get(); }
  std::uint64_t memory_bytes() const { return memory_bytes_.load(std::memory_order_relaxed); }

 private:
  struct BottomLevel {
    std::vector<std::shared_ptr<const Primitive>> primitives;  // keep the key's addresses and the indices alive
    EmbreeSceneHandle scene;
    std::shared_ptr<const DeformedShape> shape;
    float built_area_m2 = 0.0f;  // of the bounds when the hierarchy was built
    std::uint64_t built_in = 0;  // frame of the last build or refit
    std::uint64_t last_used = 0;
  };
  struct Slot {  // one instance in the top level
    EmbreeGeometry geometry;
    const BottomLevel* shows = nullptr;
    std::uint64_t shown_build = 0;
    glm::mat4 world_from_object{0.0f};
    glm::mat3 normal_from_object{0.0f};  // keeps front and back where the winding has them, mirrored or not
  };

  struct Placed {  // where an instance's triangles are; valid as long as the frame's Pose
    const glm::vec3* positions;
    const std::uint32_t* indices;
    glm::mat4 world_from_object;
  };

  void prepare_coverage_tests(const TraceScene& scene, std::vector<bool>& filtered);
  BottomLevel& bottom_level(const GeometryGroup& group, std::span<const Instance> instances);
  void build(BottomLevel& level, const GeometryGroup& group, std::span<const Instance> instances);
  void refit_deformed(const std::vector<GeometryGroup>& groups, const std::vector<BottomLevel*>& levels,
                      std::span<const Instance> instances, ThreadPool& threads);
  void refit(BottomLevel& level, const GeometryGroup& group) const;
  void rebuild_top_level(const std::vector<GeometryGroup>& groups, const std::vector<BottomLevel*>& levels);
  bool show(Slot& slot, std::uint32_t id, const BottomLevel& level, const glm::mat4& world_from_object);
  void drop_unused();
  void throw_on_error() const;
  static void throw_on(RTCError error);

  std::atomic<std::int64_t> memory_bytes_{0};  // outlives the device, which counts into it
  EmbreeDevice device_;
  std::map<GeometryKey, std::unique_ptr<BottomLevel>> bottom_levels_;
  EmbreeSceneHandle top_level_;
  std::vector<Slot> slots_;
  float triangle_size_m_ = 0.0f;
  std::uint64_t frame_ = 0;

  AlphaRanges alpha_ranges_;
  std::vector<std::uint32_t> first_instances_;  // by slot
  std::vector<CoverageTest> coverage_;          // by instance, as are the following
  std::vector<const Primitive*> primitives_;
  std::vector<bool> double_sided_;
  std::vector<Placed> placed_;
  std::vector<std::shared_ptr<const Image>> images_;  // keep CoverageTest::image alive
};

/// What rays carry to the coverage filter. Its first member is what Embree knows.
struct EmbreeContext {
  RTCIntersectContext embree;
  const EmbreeScene* scene;
};

}  // namespace lightwell
