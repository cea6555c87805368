#include "server/command_line/thesis/bench_plot.h"

#include <algorithm>
#include <array>
#include <string>

namespace lightwell {

namespace {

// Colours that stay apart for the colour-blind: Okabe and Ito 2008.
constexpr std::array<const char*, 3> kColors = {"#d55e00", "#0072b2", "#009e73"};

// The curves for one size of the indirect map.
void add_curves(Plot& plot, const std::vector<MeasuredRow>& rows, int indirect_side_px) {
  const std::string size = std::to_string(indirect_side_px);
  const std::string color = kColors[plot.curves.size() / 2 % kColors.size()];
  PlotCurve ours{"here, indirect " + size, color, false, {}};
  PlotCurve printed{"2009, indirect " + size, color, true, {}};
  for (const MeasuredRow& row : rows) {
    if (row.indirect_side_px != indirect_side_px) continue;
    ours.points.emplace_back(row.printed.samples, row.frames_per_s());
    printed.points.emplace_back(row.printed.samples, row.printed.frames_per_s);
  }
  plot.curves.push_back(std::move(ours));
  plot.curves.push_back(std::move(printed));
}

void add_table(std::vector<Plot>& plots, const ThesisBench& bench, std::string_view table) {
  std::vector<MeasuredRow> rows;
  std::vector<int> sides_px;
  for (const MeasuredRow& row : bench.rows) {
    if (row.printed.table != table) continue;
    rows.push_back(row);
    if (std::find(sides_px.begin(), sides_px.end(), row.indirect_side_px) == sides_px.end())
      sides_px.push_back(row.indirect_side_px);
  }
  if (rows.empty()) return;
  Plot plot{"Table " + std::string(table) + ": " + std::string(rows.front().printed.scene),
            "samples per pixel",
            "frames a second",
            {32, 64, 128, 256, 512},
            {}};
  for (const int side_px : sides_px) add_curves(plot, rows, side_px);
  plots.push_back(std::move(plot));
}

}  // namespace

std::vector<Plot> plots_of(const ThesisBench& bench) {
  std::vector<Plot> plots;
  add_table(plots, bench, "6.1");
  add_table(plots, bench, "6.2");
  if (bench.terrains.empty()) return plots;
  Plot cost{"Cost against triangles", "triangles", "milliseconds a frame", {1e3, 1e4, 1e5, 1e6, 1e7}, {}};
  PlotCurve frame{"frame", kColors[0], false, {}}, trace{"of it: trace", kColors[1], false, {}};
  PlotCurve brute_force{"tracing by brute force", kColors[2], false, {}};
  for (const MeasuredTerrain& terrain : bench.terrains) {
    const auto triangles = static_cast<double>(terrain.triangles);
    frame.points.emplace_back(triangles, terrain.median.ms);
    if (terrain.brute_force) brute_force.points.emplace_back(triangles, tracing_ms(*terrain.brute_force));
    for (const StageCost& stage : terrain.median.stages)
      if (stage.name == "trace" && stage.ms > 0.0) trace.points.emplace_back(triangles, stage.ms);
  }
  cost.curves = {std::move(frame), std::move(trace)};
  if (!brute_force.points.empty()) cost.curves.push_back(std::move(brute_force));
  plots.push_back(std::move(cost));
  return plots;
}

}  // namespace lightwell
