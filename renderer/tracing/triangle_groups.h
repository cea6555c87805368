// All triangles in k groups (thesis 5.1), so that a patch's ray finds the nearest one of each.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "renderer/tracing/tracer.h"

namespace lightwell {

/// Triangle t of group g is triangle t * k + g of its primitive. Groups have hierarchies of their own.
class TriangleGroups {
 public:
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
  const Parts& parts_of(const std::shared_ptr<const Primitive>& primitive, std::uint32_t count);

  std::function<std::unique_ptr<Tracer>()> make_tracer_;
  std::vector<std::unique_ptr<Tracer>> tracers_;  // one a group
  std::map<const Primitive*, Parts> primitives_;
  std::uint64_t frame_ = 0;
};

}  // namespace lightwell
