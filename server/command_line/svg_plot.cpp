#include "server/command_line/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "renderer/check.h"

namespace lightwell {

namespace {

constexpr double kPlotWidth = 420.0, kPlotHeight = 440.0;
constexpr double kLeft = 62.0, kTop = 40.0, kRight = 14.0, kBottom = 132.0;  // margins about the axes
constexpr double kLegendLine = 17.0;

// Formats every number by the same rule.
std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

// 1500 as 1.5k: ticks have little room.
std::string tick_text(double value) {
  if (value >= 1e6) return number(std::round(value / 1e4) / 100.0) + "M";
  if (value >= 1e3) return number(std::round(value / 100.0) / 10.0) + "k";
  return number(value);
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else
      out += c;
  }
  return out;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text,
                    const std::string& attributes = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" + attributes + ">" +
         escaped(text) + "</text>\n";
}

std::string line(double x0, double y0, double x1, double y1, const std::string& attributes) {
  return "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) + "\" y2=\"" + number(y1) +
         "\" " + attributes + "/>\n";
}

std::string stroke(const PlotCurve& curve) {
  return "stroke=\"" + curve.color + "\" stroke-width=\"1.8\" fill=\"none\"" +
         (curve.dashed ? " stroke-dasharray=\"5 4\"" : "");
}

// One plot's axes: values to places.
struct Axes {
  double left, x_low, x_high, y_low, y_high;  // logarithms to base 10

  Axes(const Plot& plot, double left_px) : left(left_px) {
    LIGHTWELL_CHECK_OP(plot.x_ticks.size(), >=, 2u);
    x_low = std::log10(plot.x_ticks.front());
    x_high = std::log10(plot.x_ticks.back());
    double least = 1e300, most = 0.0;
    for (const PlotCurve& curve : plot.curves)
      for (const glm::dvec2& point : curve.points) least = std::min(least, point.y), most = std::max(most, point.y);
    y_low = most > 0.0 ? std::floor(std::log10(least)) : 0.0;
    y_high = most > 0.0 ? std::max(std::ceil(std::log10(most)), y_low + 1.0) : 1.0;
  }
  double width() const { return kPlotWidth - kLeft - kRight; }
  double height() const { return kPlotHeight - kTop - kBottom; }
  double x(double value) const { return left + kLeft + width() * (std::log10(value) - x_low) / (x_high - x_low); }
  double y(double value) const { return kTop + height() * (y_high - std::log10(value)) / (y_high - y_low); }
};

std::string grid(const Plot& plot, const Axes& axes) {
  std::string svg;
  const double left = axes.left + kLeft, right = left + axes.width(), bottom = kTop + axes.height();
  for (const double tick : plot.x_ticks) {
    svg += line(axes.x(tick), kTop, axes.x(tick), bottom, "stroke=\"#ddd\"");
    svg += text_at(axes.x(tick), bottom + 16.0, "middle", tick_text(tick));
  }
  for (int decade = static_cast<int>(axes.y_low); decade <= static_cast<int>(axes.y_high); ++decade)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10.0, decade);
      if (std::log10(value) > axes.y_high + 1e-9) break;
      svg += line(left, axes.y(value), right, axes.y(value), factor == 1.0 ? "stroke=\"#ccc\"" : "stroke=\"#eee\"");
      svg += text_at(left - 6.0, axes.y(value) + 4.0, "end", tick_text(value));
    }
  svg += text_at(left, 24.0, "start", plot.title, " font-weight=\"bold\"");
  svg += text_at((left + right) / 2.0, bottom + 34.0, "middle", plot.x_title);
  const double middle = kTop + axes.height() / 2.0;
  return svg + text_at(axes.left + 16.0, middle, "middle", plot.y_title,
                       " transform=\"rotate(-90 " + number(axes.left + 16.0) + " " + number(middle) + ")\"");
}

std::string curves(const Plot& plot, const Axes& axes) {
  std::string svg;
  for (const PlotCurve& curve : plot.curves) {
    std::string points;
    for (const glm::dvec2& point : curve.points) {
      points += number(axes.x(point.x)) + "," + number(axes.y(point.y)) + " ";
      svg += "<circle cx=\"" + number(axes.x(point.x)) + "\" cy=\"" + number(axes.y(point.y)) + "\" r=\"2.6\" fill=\"" +
             (curve.dashed ? "white" : curve.color) + "\" stroke=\"" + curve.color + "\"/>\n";
    }
    svg += "<polyline points=\"" + points + "\" " + stroke(curve) + "/>\n";
  }
  return svg;
}

std::string legend(const Plot& plot, const Axes& axes) {
  std::string svg;
  std::vector<std::string> shown;
  for (const PlotCurve& curve : plot.curves) {
    if (std::find(shown.begin(), shown.end(), curve.label) != shown.end()) continue;
    // Two columns.
    const double x = axes.left + kLeft + (shown.size() % 2 == 0 ? 0.0 : axes.width() / 2.0);
    const double y = kPlotHeight - kBottom + 54.0 + kLegendLine * static_cast<double>(shown.size() / 2);
    svg += line(x, y - 4.0, x + 24.0, y - 4.0, stroke(curve)) + text_at(x + 30.0, y, "start", curve.label);
    shown.push_back(curve.label);
  }
  return svg;
}

}  // namespace

std::string svg_of(const std::vector<Plot>& plots) {
  const std::string width = number(kPlotWidth * static_cast<double>(plots.size())), height = number(kPlotHeight);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
                    "\" viewBox=\"0 0 " + width + " " + height + "\" font-family=\"sans-serif\" font-size=\"12\">\n" +
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const Axes axes(plots[i], kPlotWidth * static_cast<double>(i));
    svg += grid(plots[i], axes) + curves(plots[i], axes) + legend(plots[i], axes);
  }
  return svg + "</svg>\n";
}

}  // namespace lightwell
