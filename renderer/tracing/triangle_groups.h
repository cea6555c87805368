// All triangles in k groups (thesis 5.1), so that a patch's ray finds the nearest one of each.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "renderer/tracing/tracer.h"

namespace lightwell {

/// Triangle t of group g is triangle t * k + g of its primitive. Groups have hierarchies of their own, which are kept
/// for a few values of k at once, so that sessions with different ones can take turns: until another kMostKept values
/// have been asked for, none has for kFramesUntilDropped frames, or nobody else holds their primitives any more.
class TriangleGroups {
 public:
  static constexpr std::size_t kMostKept = 4;
  static constexpr std::uint64_t kFramesUntilDropped = 120;

  explicit TriangleGroups(std::function<std::unique_ptr<Tracer>()> make_tracer);

  /// Takes the instances of this frame in `count` groups.
  void update(const TraceScene& scene, std::uint32_t count);

  /// As Tracer::closest_hit, for each group of the last update: hits[group * count + ray]. `scratch` as `hits`, for
  /// those of one group.
  void closest_hits(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits, gl::Buffer& scratch);

 private:
  struct Parts {
    std::shared_ptr<const Primitive> whole;  // keeps the key's address
    std::vector<std::shared_ptr<const Primitive>> parts;
    std::uint64_t last_used = 0;
  };
  struct Groups {                                  // of one k
    std::vector<std::unique_ptr<Tracer>> tracers;  // one a group
    std::map<const Primitive*, Parts> primitives;
    std::uint64_t last_used = 0;
  };
  const Parts& parts_of(Groups& groups, const std::shared_ptr<const Primitive>& primitive) const;
  void drop_unused();

  std::function<std::unique_ptr<Tracer>()> make_tracer_;
  std::map<std::uint32_t, Groups> kept_;  // by k
  Groups* current_ = nullptr;             // of the last update
  std::uint64_t frame_ = 0;
};

}  // namespace lightwell
