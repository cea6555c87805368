// Curves over two logarithmic axes, as an SVG picture.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace lightwell {

struct PlotCurve {
  std::string label;  // curves of the same label share one line of the legend
  std::string color;  // as SVG names it
  bool dashed = false;
  std::vector<glm::dvec2> points;  // both coordinates above 0
};

struct Plot {
  std::string title, x_title, y_title;
  std::vector<double> x_ticks;  // above 0, rising, at least two; they span the axis
  std::vector<PlotCurve> curves;
};

/// The plots side by side, each with its legend. The y axis of each runs over whole decades around its points.
std::string svg_of(const std::vector<Plot>& plots);

}  // namespace lightwell
