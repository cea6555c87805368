// Hits of pixels that have nothing in common, gathered a vector at a time.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "renderer/lanes/choose.h"
#include "renderer/passes/placed_triangles.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

class ScatteredHits {
 public:
  /// Sums go to `pixels`.
  ScatteredHits(lanes::PatchPixels& pixels, TriangleCache& triangles, const lanes::LightEnvironment& environment);

  /// What the ray from PatchPixels::from of a pixel meets, or that it sees the sky.
  void add(std::uint32_t pixel, const lanes::PatchDirection& direction, const Hit& hit);
  /// Gathers what is left.
  void finish();

 private:
  void add_surface(std::uint32_t lane, const lanes::HitSurface& surface, glm::vec3 direction);

  lanes::PatchPixels& pixels_;
  TriangleCache& triangles_;
  const lanes::LightEnvironment& environment_;
  lanes::PatchPixels lane_pixels_;
  lanes::ScatteredRays rays_;
  std::array<std::uint32_t, lanes::kMostLanes> pixel_of_lane_;
  std::uint32_t count_ = 0;
};

}  // namespace lightwell
