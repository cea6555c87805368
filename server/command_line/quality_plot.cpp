#include "server/command_line/quality_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace lightwell {

namespace {

constexpr double kPanelWidth = 360.0, kPanelHeight = 260.0, kLeft = 62.0, kTop = 34.0, kRight = 14.0, kBottom = 44.0;
constexpr std::array<const char*, 6> kColors = {"#c2410c", "#1d4ed8", "#a16207", "#15803d", "#0e7490", "#7e22ce"};

struct Decades {  // an axis from 10^first to 10^last
  int first = 0, last = 1;
  double share(double value) const { return (std::log10(value) - first) / (last - first); }
};

double shown(double value) {
  return std::clamp(std::isfinite(value) ? value : 1e9, 1e-9, 1e9);
}

template <class Value>
Decades decades_of(const std::vector<SceneQuality>& scenes, Value value) {
  double least = 1e9, most = 1e-9;
  for (const SceneQuality& scene : scenes)
    for (const QualityResult& result : scene.results) {
      least = std::min(least, shown(value(result)));
      most = std::max(most, shown(value(result)));
    }
  const int first = static_cast<int>(std::floor(std::log10(least)));
  return {first, std::max(first + 1, static_cast<int>(std::ceil(std::log10(most))))};
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string label(double x, double y, const char* anchor, const std::string& text) {
  return format("<text x='%.1f' y='%.1f' text-anchor='%s'>", x, y, anchor) + text + "</text>\n";
}

struct Panel {
  double left, top;
  Decades ms, error;
  double x(double value) const { return left + ms.share(shown(value)) * (kPanelWidth - kLeft - kRight); }
  double y(double value) const { return top + (1.0 - error.share(shown(value))) * (kPanelHeight - kTop - kBottom); }

  std::string axes(const std::string& title) const {
    const double right = x(std::pow(10.0, ms.last)), bottom = y(std::pow(10.0, error.first));
    std::string svg =
        label(0.5 * (left + right), top - 12.0, "middle", "<tspan font-weight='bold'>" + title + "</tspan>");
    for (int decade = ms.first; decade <= ms.last; ++decade) {
      const double at = x(std::pow(10.0, decade));
      svg += format("<path d='M%.1f %.1fV%.1f' stroke='#ddd'/>\n", at, top, bottom);
      svg += label(at, bottom + 15.0, "middle", format("%g", std::pow(10.0, decade)));
    }
    for (int decade = error.first; decade <= error.last; ++decade) {
      const double at = y(std::pow(10.0, decade));
      svg += format("<path d='M%.1f %.1fH%.1f' stroke='#ddd'/>\n", left, at, right);
      svg += label(left - 6.0, at + 4.0, "end", format("%g", std::pow(10.0, decade)));
    }
    return svg + label(0.5 * (left + right), bottom + 31.0, "middle", "milliseconds");
  }

  std::string line(const std::vector<const QualityResult*>& points, const char* color) const {
    std::string path, dots;
    for (const QualityResult* point : points) {
      path += format("%s%.1f %.1f", path.empty() ? "M" : "L", x(point->ms), y(point->rel_mse));
      dots += format("<circle cx='%.1f' cy='%.1f' r='3.5' fill='%s'><title>", x(point->ms), y(point->rel_mse), color) +
              point->series + ", " + point->setting + "</title></circle>\n";
    }
    return "<path d='" + path + "' fill='none' stroke-width='1.5' stroke='" + color + "'/>\n" + dots;
  }
};

std::vector<std::string> series_of(const std::vector<SceneQuality>& scenes) {
  std::vector<std::string> names;
  for (const SceneQuality& scene : scenes)
    for (const QualityResult& result : scene.results)
      if (std::find(names.begin(), names.end(), result.series) == names.end()) names.push_back(result.series);
  return names;
}

}  // namespace

std::string quality_svg(const std::vector<SceneQuality>& scenes) {
  const Decades ms = decades_of(scenes, [](const QualityResult& r) { return r.ms; });
  const Decades error = decades_of(scenes, [](const QualityResult& r) { return r.rel_mse; });
  const std::vector<std::string> series = series_of(scenes);
  const double columns = std::min<double>(2.0, static_cast<double>(scenes.size()));
  const double rows = std::ceil(static_cast<double>(scenes.size()) / 2.0);
  const double width = columns * kPanelWidth, height = rows * kPanelHeight + 48.0;
  std::string svg = format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' font-family='sans-serif' font-size='11'>\n"
      "<rect width='100%%' height='100%%' fill='white'/>\n",
      width, height);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Panel panel{static_cast<double>(i % 2) * kPanelWidth + kLeft,
                      static_cast<double>(i / 2) * kPanelHeight + kTop, ms, error};
    svg += panel.axes(scenes[i].scene + ": relMSE");
    for (std::size_t k = 0; k < series.size(); ++k) {
      std::vector<const QualityResult*> points;
      for (const QualityResult& result : scenes[i].results)
        if (result.series == series[k]) points.push_back(&result);
      svg += panel.line(points, kColors[k % kColors.size()]);
    }
  }
  for (std::size_t k = 0; k < series.size(); ++k) {
    const double x = kLeft + 230.0 * static_cast<double>(k % 3);
    const double y = height - 32.0 + 18.0 * static_cast<double>(k / 3);
    svg += format("<circle cx='%.1f' cy='%.1f' r='4' fill='%s'/>\n", x, y, kColors[k % kColors.size()]);
    svg += label(x + 9.0, y + 4.0, "start", series[k]);
  }
  return svg + "</svg>\n";
}

}  // namespace lightwell
