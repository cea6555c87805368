// The wide hierarchy of a scene of few triangles, in world space. What lies together in a mesh stays a leaf wherever it
// goes; the boxes over all leaves are sorted anew in every frame.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "renderer/tracing/collapse_bvh.h"
#include "renderer/tracing/geometry_groups.h"
#include "renderer/tracing/thread_pool.h"

namespace lightwell {

class WorldHierarchy {
 public:
  /// With more triangles it does not pay to sort their leaves in every frame.
  static constexpr std::size_t kMostTriangles = 32768;

  /// Null where there are more than these, none at all, or some whose coverage must be tested. Valid until the next
  /// call.
  const WideHierarchy* update(const TraceScene& scene, ThreadPool& threads);

  std::uint64_t memory_bytes() const;

 private:
  /// Which triangles of a group share a leaf, wherever they are.
  struct Topology {
    std::vector<std::shared_ptr<const Primitive>> primitives;  // keep the key's addresses alive
    std::vector<BvhRange> leaves;                              // of `items`
    std::vector<std::uint32_t> items;                          // triangles, counted primitive by primitive
  };
  struct Placed {  // a group in this frame
    std::shared_ptr<const Topology> topology;
    std::uint32_t first_leaf;
    glm::mat4 world_from_object{0.0f};
    std::shared_ptr<const DeformedShape> shape;
    float area_m2 = 0.0f, built_area_m2 = 0.0f;  // of all leaves' boxes; when it was laid out
  };

  std::shared_ptr<const Topology> topology_of(const GeometryGroup& group, std::span<const Instance> instances) const;
  void lay_out(std::vector<GeometryGroup> groups, std::span<const Instance> instances);
  bool place(const GeometryGroup& group, Placed& placed);
  void place_triangles(const GeometryGroup& group, const Placed& placed);
  void fit_boxes(Placed& placed);
  void forget_degraded();

  std::map<GeometryKey, std::shared_ptr<const Topology>> topologies_;
  std::vector<GeometryGroup> groups_;  // as they were laid out
  std::vector<Placed> placed_;
  std::vector<WideLeaf> leaves_;
  std::vector<Box> boxes_;  // of the leaves
  std::vector<WideNode> nodes_;
  WideHierarchy hierarchy_{};
};

}  // namespace lightwell
