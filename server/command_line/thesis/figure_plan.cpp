#include "server/command_line/thesis/figure_plan.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace lightwell {

namespace {

// When everything is in view and the search light shows.
constexpr double kHelicoptersTime_s = 6.0, kVenusTime_s = 3.0;

constexpr std::array<int, 3> kIndirectSides_px = {512, 256, 128};
constexpr int kSeriesSamples = 128, kSeriesIndirectSide_px = 256;
constexpr std::array<double, 4> kSeriesTimes_s = {0.0, 3.0, 6.0, 9.0};

FigurePanel direct_only(double time_s) {
  return {"direct", "direct light only", time_s, ViewKind::kDirect, 0, kIndirectSides_px.front()};
}

FigurePanel with_parameters(double time_s, int samples, int indirect_side_px) {
  const std::string count = std::to_string(samples), side = std::to_string(indirect_side_px);
  return {count + "-samples-indirect-" + side,
          count + " samples, indirect " + side,
          time_s,
          ViewKind::kFinal,
          samples,
          indirect_side_px};
}

// A column for each number of samples, a row for each size of the indirect map; direct light alone in a column before.
Figure parameters_figure(std::string number, std::string scene, double time_s, bool with_direct,
                         const std::vector<int>& samples) {
  Figure figure{"", scene, "Figure " + number + ": " + scene + ", by samples and side of the indirect map", 0, {}};
  figure.number = std::move(number);
  figure.columns = static_cast<int>(samples.size()) + (with_direct ? 1 : 0);
  for (const int side_px : kIndirectSides_px) {
    const bool first = side_px == kIndirectSides_px.front();
    if (with_direct) figure.cells.push_back(first ? std::optional(direct_only(time_s)) : std::nullopt);
    for (const int count : samples) figure.cells.emplace_back(with_parameters(time_s, count, side_px));
  }
  return figure;
}

Figure series_figure(std::string number, std::string scene) {
  Figure figure{"", scene, "Figure " + number + ": " + scene + ", everything moves", 3, {}};
  figure.number = std::move(number);
  for (const double time_s : kSeriesTimes_s) {
    const std::string moment = std::to_string(static_cast<int>(time_s)) + "s";
    for (const auto& [view, name] : {std::pair(ViewKind::kDirect, "direct"), std::pair(ViewKind::kIndirect, "indirect"),
                                     std::pair(ViewKind::kFinal, "both")}) {
      const std::string caption = moment.substr(0, moment.size() - 1) + " s: " + name;
      const int samples = view == ViewKind::kDirect ? 0 : kSeriesSamples;
      figure.cells.emplace_back(
          FigurePanel{moment + "-" + name, caption, time_s, view, samples, kSeriesIndirectSide_px});
    }
  }
  return figure;
}

}  // namespace

std::vector<Figure> thesis_figures() {
  return {parameters_figure("6.1", "helicopters", kHelicoptersTime_s, true, {32, 64}),
          parameters_figure("6.2", "helicopters", kHelicoptersTime_s, false, {96, 128, 256, 512}),
          parameters_figure("6.3", "venus", kVenusTime_s, true, {32, 64}),
          parameters_figure("6.4", "venus", kVenusTime_s, false, {96, 128, 256, 512}),
          series_figure("6.5", "helicopters"),
          series_figure("6.6", "venus")};
}

Result<std::vector<Figure>> select_figures(const std::string& text) {
  std::vector<Figure> all = thesis_figures();
  if (text == "all") return all;
  std::vector<std::string> wanted;
  std::istringstream parts(text + ",");
  for (std::string part; std::getline(parts, part, ',');) {
    if (std::none_of(all.begin(), all.end(), [&](const Figure& figure) { return figure.number == part; }))
      return invalid_input("", "expected all, or figures from 6.1 to 6.6 such as 6.1,6.5, not \"" + text + "\"");
    wanted.push_back(part);
  }
  std::erase_if(all, [&](const Figure& figure) {
    return std::find(wanted.begin(), wanted.end(), figure.number) == wanted.end();
  });
  return all;
}

}  // namespace lightwell
