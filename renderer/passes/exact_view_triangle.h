// A triangle of a view in double precision, pixel by pixel: for those that reach behind the eye, or so far out of the
// picture that floats do not tell where their edges are. In homogeneous coordinates (Olano and Greer 1997).
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "renderer/lanes/view_triangles.h"

namespace lightwell {

class ExactViewTriangle {
 public:
  /// `corners`: as ViewTriangles::rows gives them. `front` as there.
  ExactViewTriangle(const std::array<glm::dvec3, 3>& corners, double front, std::uint32_t number,
                    const lanes::ViewTarget& target);

  bool is_in_picture() const { return first_px_.x < end_px_.x && first_px_.y < end_px_.y; }

  /// Draws those of the rows [begin, end) that it reaches.
  void draw(const lanes::ViewTarget& target, int begin, int end) const;

 private:
  void find_bounds(const std::array<glm::dvec3, 3>& corners, const lanes::ViewTarget& target);
  void draw_pixel(const lanes::ViewTarget& target, int x, int y) const;

  // Of a pixel (x, y, 1): products with edges_ are the barycentrics, times 1 / t in a perspective view.
  std::array<glm::dvec3, 3> edges_;
  std::array<double, 3> pixels_;  // by how much a barycentric changes over one pixel
  glm::dvec3 q_{0.0};             // the product is t, or 1 / t in a perspective view
  std::uint32_t number_;
  glm::ivec2 first_px_{0}, end_px_{0};
};

}  // namespace lightwell
