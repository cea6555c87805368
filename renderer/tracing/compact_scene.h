// The compact hierarchy of a scene of very many triangles: one for each mesh, kept over the frames, and a top level.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "renderer/tracing/compact_mesh.h"

namespace lightwell {

class CompactScene {
 public:
  /// A hierarchy over boxes with at most kWide of them a leaf, as build_bvh() makes it.
  using BuildBvh = std::function<Bvh(std::span<const Box>)>;

  /// Null where triangles are deformed or their coverage must be tested, or where there are none; a mesh may have fewer
  /// than BvhChild::kMostItems. Valid until the next call.
  const CompactHierarchy* update(const TraceScene& scene, ThreadPool& threads, const BuildBvh& build);

  std::uint64_t memory_bytes() const;

 private:
  struct Mesh {
    std::vector<std::shared_ptr<const Primitive>> primitives;  // keep the key's addresses alive
    CompactMesh packed;
  };
  std::shared_ptr<const Mesh> mesh_of(const GeometryGroup& group, std::span<const Instance> instances,
                                      ThreadPool& threads, const BuildBvh& build) const;

  std::map<GeometryKey, std::shared_ptr<const Mesh>> meshes_;
  std::vector<CompactInstance> instances_;
  std::vector<CompactNode> nodes_;
  CompactHierarchy hierarchy_{};
};

}  // namespace lightwell
