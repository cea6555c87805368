// A tracer that runs on the processor, as other code there sees it.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "renderer/tracing/compact_hierarchy.h"
#include "renderer/tracing/tracer.h"
#include "renderer/tracing/wide_hierarchy.h"

namespace lightwell {

class HostTracer {
 public:
  virtual ~HostTracer() = default;
  /// As ThreadPool::parallel_for, on the tracer's threads.
  virtual void parallel_for(std::uint32_t count, std::uint32_t chunk,
                            const std::function<void(std::uint32_t begin, std::uint32_t end)>& body) = 0;
  /// As Tracer::closest_hit, at once and on the thread that calls, for at most 1024 rays; `hits` is as long.
  virtual void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const = 0;
  /// Everything as it was at the last update, for rays that share a direction; null where there is too much of it, or
  /// coverage to be tested. Not for several threads at once; valid until the next update.
  virtual const WideHierarchy* wide_hierarchy() = 0;
  /// The same for any number of triangles, but that none may be deformed, for rays each on its own.
  virtual const CompactHierarchy* compact_hierarchy() = 0;
  /// The corners of a triangle in the world.
  virtual std::array<glm::vec3, 3> corners_ws(std::uint32_t instance, std::uint32_t triangle) const = 0;
};

}  // namespace lightwell
