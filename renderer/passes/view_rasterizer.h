// Views of very many triangles, drawn by the processor where it is quicker than a software device: it takes in small
// triangles many at once, and keeps no order but the nearest at each pixel. A pixel sees what the ray through its
// middle meets.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <mutex>
#include <span>
#include <vector>

#include "renderer/lanes/view_triangles.h"
#include "renderer/passes/exact_view_triangle.h"
#include "renderer/passes/view_rays.h"
#include "renderer/tracing/host_tracer.h"

namespace lightwell {

class ViewRasterizer {
 public:
  /// Its loops run on the threads of `host`, not at once with others.
  ViewRasterizer(HostTracer& host, const lanes::ViewKernels& kernels) : host_(host), kernels_(kernels) {}

  /// What views show from now on; valid as long as the scene's instances are.
  void update(const TraceScene& scene);
  /// Since then.
  std::uint32_t views_drawn() const { return views_drawn_; }

  /// hits[y * width + x]: the nearest surface that a camera sees, t = kMiss where there is none. Of triangles that are
  /// not Coverage::double_sided the front alone counts. Waits for the device, which reads `hits` afterwards.
  void camera_hits(const ViewRays& rays, gl::Buffer& hits);
  /// depths[y * width + x], as ViewDepth: the nearest surface, both sides of which count. Otherwise as camera_hits.
  void depths(const ViewRays& rays, DepthMeasure measure, float factor, gl::Buffer& depths);

  /// The same into memory, for width * height pixels.
  void camera_hits(const ViewRays& rays, Hit* hits);
  void depths(const ViewRays& rays, DepthMeasure measure, float factor, ViewDepth* depths);

 private:
  struct View;
  struct Chunk {
    std::uint32_t instance, first, count;  // triangles
  };

  void draw(const View& view);
  void draw_chunk(const View& view, const Chunk& chunk);
  void keep_for_later(const lanes::ViewLeftovers& left, const lanes::ViewTriangles& triangles,
                      const glm::dmat4x3& from_object, double front, const lanes::ViewTarget& target);
  void find_hits(const View& view, glm::ivec2 first, int count, Hit* hits) const;
  void find_barycentrics(const ViewRays& rays, glm::ivec2 first, std::span<Hit> hits) const;
  std::uint32_t instance_of(std::uint32_t number, std::uint32_t guess) const;

  HostTracer& host_;
  const lanes::ViewKernels& kernels_;
  TraceScene scene_;
  std::vector<std::uint32_t> first_numbers_;  // of each instance's triangles, and one past the last
  std::vector<Chunk> chunks_;
  std::uint32_t views_drawn_ = 0;
  std::vector<std::uint64_t> nearest_;  // as lanes::ViewTarget::nearest

  std::mutex mutex_;
  std::vector<lanes::ViewTriangle> large_;  // these are drawn by rows, after the others
  std::vector<ExactViewTriangle> exact_;
};

}  // namespace lightwell
