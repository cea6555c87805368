// Triangles where they are in the world, with what they reflect, for code on the processor.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/lanes/affine_triangle.h"
#include "renderer/passes/device_scene.h"
#include "renderer/tracing/host_tracer.h"

namespace lightwell {

struct PlacedTriangle {
  std::uint32_t instance = ~0u, triangle = ~0u;
  std::array<glm::vec3, 3> corners_ws;
  lanes::HitSurface surface;
};

/// 1 if rays of the direction come from the side of the geometric normal, else -1.
float side_of(const lanes::HitSurface& surface, glm::vec3 direction);

/// The triangles that a thread met last: neighbours in patches and directions meet the same ones.
class TriangleCache {
 public:
  TriangleCache(const DeviceScene::HostHitData& scene, const HostTracer& tracer) : scene_(scene), tracer_(tracer) {}

  /// Valid until the next call.
  const PlacedTriangle& at(std::uint32_t instance, std::uint32_t triangle);

 private:
  const DeviceScene::HostHitData& scene_;
  const HostTracer& tracer_;
  std::array<PlacedTriangle, 128> placed_;
};

}  // namespace lightwell
