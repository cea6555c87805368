// Hits of pixels that have nothing in common, gathered a vector at a time.
#pragma once

#include "renderer/lanes/choose.h"
#include "renderer/passes/placed_triangles.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

class ScatteredHits {
 public:
  /// Sums go to `pixels`.
  ScatteredHits(lanes::PatchPixels& pixels, TriangleCache& triangles, const lanes::LightEnvironment& environment);

  /// What a ray of a pixel meets, or that it sees the sky.
  void add(std::uint32_t pixel, glm::vec3 from_ws, const lanes::PatchDirection& direction, const Hit& hit);
  /// Gathers what is left.
  void finish();

 private:
  lanes::PatchPixels& pixels_;
  TriangleCache& triangles_;
  const lanes::LightEnvironment& environment_;
  lanes::ScatteredRays rays_;
  std::uint32_t count_ = 0;
};

}  // namespace lightwell
