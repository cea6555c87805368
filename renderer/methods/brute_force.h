// Rays that try every triangle, as the thesis' own did: who traces them, and how many a frame may have.
#pragma once

#include <functional>
#include <memory>

#include "renderer/renderer.h"
#include "renderer/tracing/tracer.h"
#include "renderer/tracing/triangle_groups.h"

namespace lightwell {

/// What a frame's rays are traced by: the tracer, and those of the groups of its triangles.
struct Tracing {
  explicit Tracing(const std::function<std::unique_ptr<Tracer>()>& make_tracer)
      : tracer(make_tracer()), triangle_groups(make_tracer) {}
  std::unique_ptr<Tracer> tracer;
  TriangleGroups triangle_groups;
};

/// Refuses a frame with Settings::brute_force that would keep a device busy for seconds, and all other sessions
/// waiting: rays times triangles, as if no patch shared any. `software`: the device is one.
Status check_brute_force(const Settings& settings, glm::ivec2 size_px, std::uint64_t triangles, bool software);

}  // namespace lightwell
