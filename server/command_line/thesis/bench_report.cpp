#include "server/command_line/thesis/bench_report.h"

#include <algorithm>
#include <cstdio>

namespace lightwell {

namespace {

using Lines = std::vector<std::vector<std::string>>;

std::string number(double value, int decimals) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

// Three digits are what a measurement holds.
std::string figure(double value) {
  return number(value, value < 10.0 ? 2 : value < 100.0 ? 1 : 0);
}

std::string square(int side) {
  return std::to_string(side) + "x" + std::to_string(side);
}

// Frames with other settings may have other stages.
template <class Measured>
std::vector<std::string> stage_names(const std::vector<Measured>& all) {
  std::vector<std::string> names;
  for (const Measured& one : all)
    for (const StageCost& stage : one.median.stages)
      if (std::find(names.begin(), names.end(), stage.name) == names.end()) names.push_back(stage.name);
  return names;
}

void add_stages(std::vector<std::string>& line, const std::vector<std::string>& names, const FrameCost& cost) {
  for (const std::string& name : names) {
    const auto stage =
        std::find_if(cost.stages.begin(), cost.stages.end(), [&](const StageCost& one) { return one.name == name; });
    line.push_back(stage == cost.stages.end() ? "-" : figure(stage->ms));
  }
}

std::string table(const ThesisBench& bench, std::string_view name) {
  std::vector<MeasuredRow> rows;
  for (const MeasuredRow& row : bench.rows)
    if (row.printed.table == name) rows.push_back(row);
  if (rows.empty()) return "";
  const std::vector<std::string> stages = stage_names(rows);
  Lines lines = {{"row", "samples", "indirect", "2009 fps", "fps", "ratio", "resolved M/s", "traced M/s", "relMSE",
                  "frames", "frame ms"}};
  lines[0].insert(lines[0].end(), stages.begin(), stages.end());
  for (const MeasuredRow& row : rows) {
    lines.push_back({std::to_string(row.printed.number), std::to_string(row.printed.samples),
                     square(row.indirect_side_px), number(row.printed.frames_per_s, 2), figure(row.frames_per_s()),
                     number(row.ratio(), 2), figure(row.rays_resolved_per_s() / 1e6),
                     figure(row.rays_traced_per_s() / 1e6), number(row.rel_mse, 4), std::to_string(row.frames),
                     figure(row.median.ms)});
    add_stages(lines.back(), stages, row.median);
  }
  const PrintedRow& first = rows.front().printed;
  return "\nTable " + std::string(name) + ": " + std::string(first.scene) + ", " + std::to_string(first.triangles) +
         " triangles; medians, stages in ms\n" + aligned(lines);
}

std::string summary(const ThesisBench& bench) {
  if (bench.rows.empty()) return "";
  const auto by_ratio = [](const MeasuredRow& a, const MeasuredRow& b) { return a.ratio() < b.ratio(); };
  const auto [worst, best] = std::minmax_element(bench.rows.begin(), bench.rows.end(), by_ratio);
  const auto reached =
      std::count_if(bench.rows.begin(), bench.rows.end(), [](const auto& r) { return r.ratio() >= 1; });
  std::string text = "\n" + std::to_string(reached) + " of " + std::to_string(bench.rows.size()) +
                     " rows reach the printed figure; ratios from " + number(worst->ratio(), 2) + " (row " +
                     std::to_string(worst->printed.number) + ") to " + number(best->ratio(), 2) + " (row " +
                     std::to_string(best->printed.number) + ")\n";
  if (bench.side_px != kPrintedSide_px)
    text += "the printed figures are for " + square(kPrintedSide_px) + ": these ratios compare unlike pictures\n";
  return text;
}

void add_brute_force(std::vector<std::string>& line, const MeasuredTerrain& terrain, const MeasuredTerrain& least) {
  line.push_back(figure(tracing_ms(terrain.median)));
  line.push_back(terrain.brute_force ? figure(tracing_ms(*terrain.brute_force)) : "-");
  const bool comparable = terrain.brute_force && least.brute_force && tracing_ms(*least.brute_force) > 0.0;
  line.push_back(comparable ? number(tracing_ms(*terrain.brute_force) / tracing_ms(*least.brute_force), 2) : "-");
}

std::string terrain_table(const ThesisBench& bench) {
  if (bench.terrains.empty()) return "";
  const std::vector<std::string> stages = stage_names(bench.terrains);
  const bool brute_force = bench.most_brute_triangles > 0;
  Lines lines = {{"triangles", "frame ms", "cost", "traced M/s", "frames", "first frame ms"}};
  if (brute_force) lines[0].insert(lines[0].end(), {"tracing ms", "by brute force", "cost"});
  lines[0].insert(lines[0].end(), stages.begin(), stages.end());
  for (const MeasuredTerrain& terrain : bench.terrains) {
    lines.push_back({std::to_string(terrain.triangles), figure(terrain.median.ms),
                     number(terrain.median.ms / bench.terrains.front().median.ms, 2),
                     figure(terrain.rays_traced_per_s() / 1e6), std::to_string(terrain.frames),
                     figure(terrain.first_frame_ms)});
    if (brute_force) add_brute_force(lines.back(), terrain, bench.terrains.front());
    add_stages(lines.back(), stages, terrain.median);
  }
  return "\nCost against triangles: one terrain, divided ever finer; " + std::to_string(bench.terrain_samples) +
         " samples, indirect " + square(bench.terrain_indirect_side_px) + "; medians, stages in ms\n" +
         (brute_force ? "brute force: every ray tries every triangle, one frame each, up to " +
                            std::to_string(bench.most_brute_triangles) + " triangles (--most-brute-triangles)\n"
                      : "") +
         aligned(lines);
}

nlohmann::json stages_json(const FrameCost& cost) {
  nlohmann::json stages = nlohmann::json::array();
  for (const StageCost& stage : cost.stages) stages.push_back({{"name", stage.name}, {"ms", stage.ms}});
  return stages;
}

nlohmann::json row_json(const MeasuredRow& row) {
  return {{"row", row.printed.number},
          {"table", row.printed.table},
          {"scene", row.printed.scene},
          {"triangles", row.printed.triangles},
          {"samples", row.printed.samples},
          {"indirect_size", row.indirect_side_px},
          {"printed_frames_per_s", row.printed.frames_per_s},
          {"frames_per_s", row.frames_per_s()},
          {"ratio", row.ratio()},
          {"rays_resolved_per_s", row.rays_resolved_per_s()},
          {"rays_traced_per_s", row.rays_traced_per_s()},
          {"rel_mse_to_patch_1", row.rel_mse},
          {"frames", row.frames},
          {"frame_ms", row.median.ms},
          {"stages", stages_json(row.median)}};
}

}  // namespace

std::string aligned(const Lines& lines) {
  std::vector<std::size_t> widths(lines.empty() ? 0 : lines.front().size(), 0);
  for (const auto& line : lines)
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < widths.size(); ++i)
      text += std::string((i == 0 ? 0 : 2) + widths[i] - line[i].size(), ' ') + line[i];
    text += '\n';
  }
  return text;
}

std::string text_report(const ThesisBench& bench) {
  std::string text = "device: " + bench.device + "\ntracer: " + bench.tracer +
                     "\nthreads: " + std::to_string(bench.threads) + "\npicture: " + square(bench.side_px) +
                     ", bounces: " + std::to_string(bench.bounces) + "\npatches: " + square(bench.patch) +
                     ", groups of triangles: " + std::to_string(bench.triangle_groups) +
                     "; relMSE is against patches of one pixel\n";
  return text + table(bench, "6.1") + table(bench, "6.2") + summary(bench) + terrain_table(bench);
}

nlohmann::json json_report(const ThesisBench& bench) {
  nlohmann::json rows = nlohmann::json::array(), terrains = nlohmann::json::array();
  for (const MeasuredRow& row : bench.rows) rows.push_back(row_json(row));
  for (const MeasuredTerrain& terrain : bench.terrains) {
    terrains.push_back({{"triangles", terrain.triangles},
                        {"samples", bench.terrain_samples},
                        {"indirect_size", bench.terrain_indirect_side_px},
                        {"frames", terrain.frames},
                        {"frame_ms", terrain.median.ms},
                        {"first_frame_ms", terrain.first_frame_ms},
                        {"rays_traced_per_s", terrain.rays_traced_per_s()},
                        {"stages", stages_json(terrain.median)}});
    if (terrain.brute_force)
      terrains.back()["brute_force"] = {{"frame_ms", terrain.brute_force->ms},
                                        {"tracing_ms", tracing_ms(*terrain.brute_force)},
                                        {"stages", stages_json(*terrain.brute_force)}};
  }
  return {{"device", bench.device},
          {"tracer", bench.tracer},
          {"threads", bench.threads},
          {"size", bench.side_px},
          {"bounces", bench.bounces},
          {"rows", rows},
          {"cost_against_triangles", terrains}};
}

}  // namespace lightwell
