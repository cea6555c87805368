// Rays one by one through a compact hierarchy, several on their way at once: while the memory brings what one of them
// needs next, the others go on. For files that are compiled for a kind of processor: see renderer/lanes/glsl.h.
#pragma once

#include "renderer/lanes/compact_ray.h"

namespace lightwell::lanes {
namespace {

// Rays that are computed with side by side.
class RaysTogether {
 public:
  RaysTogether(const CompactHierarchy& hierarchy, SingleRays& rays) : hierarchy_(hierarchy), rays_(rays) {
    while (idle_.count < kAtOnce) idle_.add(idle_.count);
  }

  void follow() {
    for (;;) {
      start();
      if (idle_.count == kAtOnce) return;
      take_stage(
          at_entry_, [&](const CompactRay& ray, MetByRay& met) { ray.test_entry(rays_, met); },
          [&](CompactRay& ray, const MetByRay& met) { return ray.go_on_from_entry(rays_, met); });
      take_stage(
          at_node_, [](const CompactRay& ray, MetByRay& met) { ray.test_boxes(met); },
          [](CompactRay& ray, const MetByRay& met) { return ray.go_on_from_node(met); });
      if (at_leaf_.count < kLeavesWaiting && at_node_.count > 0) continue;
      take_stage(
          at_leaf_, [](const CompactRay& ray, MetByRay& met) { ray.test_triangles(met); },
          [](CompactRay& ray, const MetByRay& met) { return ray.go_on_from_leaf(met); });
    }
  }

 private:
  static constexpr std::uint32_t kAtOnce = 32, kLeavesWaiting = 16;
  struct Places {
    std::uint32_t count = 0;
    std::uint8_t places[kAtOnce];
    void add(std::uint32_t place) { places[count++] = static_cast<std::uint8_t>(place); }
  };

  void start() {
    for (; idle_.count > 0 && started_ < rays_.count; --idle_.count) {
      const std::uint8_t place = idle_.places[idle_.count - 1];
      on_way_[place].start(hierarchy_, rays_, started_++);
      at_entry_.add(place);
    }
  }

  template <class Test, class GoOn>
  void take_stage(Places& at, const Test& test, const GoOn& go_on) {
    const std::uint32_t count = at.count;
    for (std::uint32_t i = 0; i < count; ++i) test(on_way_[at.places[i]], met_[i]);
    at.count = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint8_t place = at.places[i];
      CompactRay& ray = on_way_[place];
      if (!go_on(ray, met_[i]))
        ray.store_hit(rays_), idle_.add(place);
      else if (ray.is_at_leaf())
        at_leaf_.add(place);
      else
        at_node_.add(place);
    }
  }

  const CompactHierarchy& hierarchy_;
  SingleRays& rays_;
  std::uint32_t started_ = 0;
  Places idle_, at_entry_, at_node_, at_leaf_;
  MetByRay met_[kAtOnce];
  CompactRay on_way_[kAtOnce];
};

void nearest_single_hits(const CompactHierarchy& hierarchy, SingleRays& rays) {
  RaysTogether(hierarchy, rays).follow();
}

}  // namespace
}  // namespace lightwell::lanes
