// Which of many triangles is nearest at the middle of each of a view's pixels. Plain data and no functions but tables
// of them, for it is read by code that is compiled for several kinds of processor: see renderer/lanes/glsl.h.
#pragma once

#include <cstdint>

namespace lightwell::lanes {

/// What a pixel is given while nothing is seen there.
constexpr std::uint64_t kNothingSeen = ~std::uint64_t{0};

/// A view's picture while it comes into being. Pixel (x, y) looks along direction_ws + x * across_ws + y * down_ws.
struct ViewTarget {
  /// width_px * height_px: the bits of the depth, which is not negative, above the triangle's number or, in
  /// `as_depths`, the bits of the square of the depth's slope from pixel to pixel. So the least is the nearest.
  std::uint64_t* nearest;
  std::int32_t width_px, height_px;
  bool is_perspective;  // t is the reciprocal of what is linear in the picture, else it is linear itself
  float t_min, t_max;   // t_min > 0 if is_perspective, else >= 0
  bool as_depths;       // see above; else the depth is t
  bool as_distance;     // the depth is t times the length of the pixel's direction
  float factor;         // of depths
  float direction_ws[3], across_ws[3], down_ws[3];
};

/// Consecutive triangles under one matrix.
struct ViewTriangles {
  const float* positions;        // three for each vertex
  const std::uint32_t* indices;  // three for each triangle; below 2^29
  std::uint32_t count;           // up to kMostViewTriangles
  std::uint32_t first_number;    // of the first one; the others follow
  float rows[3][4];  // (x, y, z) = rows * (position, 1): the pixel, with z = t; the pixel times t, if is_perspective
  float front;       // sign of the areas in the picture of triangles that are seen; 0: both
};
constexpr std::uint32_t kMostViewTriangles = 1024;

/// A triangle in the picture.
struct ViewTriangle {
  float x[3], y[3];  // pixels
  float q[3];        // t, or 1 / t if is_perspective
  std::uint32_t number;
  std::int32_t first_px[2], last_px[2];  // column and row; within the picture
};

/// What `draw` leaves to others; room for all triangles.
struct ViewLeftovers {
  ViewTriangle large[kMostViewTriangles];    // more than a few pixels
  std::uint32_t beyond[kMostViewTriangles];  // numbers: reach behind the eye or far out of the picture
  std::uint32_t large_count = 0, beyond_count = 0;
};

/// Neighbouring pixels of a row of which each sees a triangle of one instance.
constexpr std::uint32_t kMostRowPixels = 32;
struct alignas(64) ViewRow {
  const float* positions;         // as in ViewTriangles
  const std::uint32_t* indices;   // likewise; of all of the instance
  float world_from_object[4][3];  // columns
  float x, y;                     // the first pixel, whose ray is as in ViewRays (renderer/passes/view_rays.h)
  float origin_ws[3], origin_across_ws[3], origin_down_ws[3];
  float direction_ws[3], direction_across_ws[3], direction_down_ws[3];
  std::uint32_t count;
  std::uint32_t triangle[kMostRowPixels];      // of the instance; those beyond `count` as well
  float u[kMostRowPixels], v[kMostRowPixels];  // what is found: where the ray meets the triangle
};

struct ViewKernels {
  const char* instructions;  // what processor they are for

  /// Draws the small ones and adds the others to `leftovers`. Several threads may draw into one target.
  void (*draw)(const ViewTriangles& triangles, const ViewTarget& target, ViewLeftovers& leftovers);
  /// Draws the rows `first_px` to `last_px` of a large one.
  void (*fill)(const ViewTriangle& triangle, const ViewTarget& target, std::int32_t first_px, std::int32_t last_px);
  /// Finds the barycentrics of what pixels see.
  void (*find_barycentrics)(ViewRow& row);
};

}  // namespace lightwell::lanes
