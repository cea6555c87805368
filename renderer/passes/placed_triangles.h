// Triangles where they are in the world, with what they reflect, for code on the processor.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "renderer/lanes/affine_triangle.h"
#include "renderer/passes/device_scene.h"
#include "renderer/tracing/host_tracer.h"

namespace lightwell {

struct PlacedTriangle {
  std::uint32_t instance = ~0u, triangle = ~0u;
  bool has_corners = false;
  std::array<glm::vec3, 3> corners_ws;  // undefined without has_corners
  lanes::HitSurface surface;
};

/// 1 if rays of the direction come from the side of the geometric normal, else -1.
float side_of(const lanes::HitSurface& surface, glm::vec3 direction);

/// The triangles that a thread met last in a frame: neighbours in patches and directions meet the same ones.
class TriangleCache {
 public:
  TriangleCache(const DeviceScene::HostHitData& scene, const HostTracer& tracer)
      : scene_(scene), tracer_(tracer), placed_(kPlaces) {}

  /// Valid until the next call, as is what at_hit() returns.
  const PlacedTriangle& at(std::uint32_t instance, std::uint32_t triangle);
  /// The same, but that it may be without corners, which lie far away in memory.
  const PlacedTriangle& at_hit(std::uint32_t instance, std::uint32_t triangle) { return place(instance, triangle); }
  /// Has the memory bring what at_hit() will read.
  void prefetch(std::uint32_t instance, std::uint32_t triangle) const;

 private:
  static std::size_t place_of(std::uint32_t instance, std::uint32_t triangle);
  PlacedTriangle& place(std::uint32_t instance, std::uint32_t triangle);

  static constexpr std::size_t kPlaces = 2048;  // 300 kB, for the second level of a processor's caches

  const DeviceScene::HostHitData scene_;
  const HostTracer& tracer_;
  std::vector<PlacedTriangle> placed_;
  std::uint32_t last_instance_ = ~0u;
  glm::mat3 normals_to_world_{1.0f};  // of the last instance
};

/// One for each thread that is at work.
class TriangleCaches {
 public:
  TriangleCaches(const DeviceScene::HostHitData& scene, const HostTracer& tracer) : scene_(scene), tracer_(tracer) {}

  std::unique_ptr<TriangleCache> take();
  void give_back(std::unique_ptr<TriangleCache> cache);

 private:
  const DeviceScene::HostHitData scene_;
  const HostTracer& tracer_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<TriangleCache>> idle_;  // guarded by mutex_
};

}  // namespace lightwell
