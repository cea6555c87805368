// The parts of `lightwell bench thesis` that need no device: the printed tables, medians, reports, curves, the terrain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "renderer/renderer.h"
#include "renderer/scene/pose.h"
#include "server/command_line/svg_plot.h"
#include "server/command_line/thesis/bench_plot.h"
#include "server/command_line/thesis/bench_report.h"
#include "server/command_line/thesis/frame_request.h"
#include "server/command_line/thesis/tessellated_terrain.h"

namespace lightwell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<int> numbers_of(const std::string& text) {
  std::vector<int> numbers;
  const std::vector<PrintedRow> rows = select_printed_rows(text).value();
  for (const PrintedRow& row : rows) numbers.push_back(row.number);
  return numbers;
}

TEST(PrintedTables, HoldEveryCombinationOnce) {
  ASSERT_EQ(printed_rows().size(), 36u);
  int number = 0;
  for (const PrintedRow& row : printed_rows()) {
    EXPECT_EQ(row.number, ++number);
    EXPECT_EQ(row.table, row.triangles == 1522 ? "6.1" : "6.2");
    EXPECT_EQ(row.scene, row.triangles == 1522 ? "helicopters" : "venus");
  }
  const PrintedRow& last = printed_rows().back();
  EXPECT_EQ(last.samples, 512);
  EXPECT_EQ(last.indirect_side_px, 128);
  EXPECT_EQ(last.frames_per_s, 0.71);
}

/// A slip of the pen would stand out: one model of the cost, linear in samples and triangles, fits all rows.
TEST(PrintedTables, FollowTheCostModelOfTheMethod) {
  for (const PrintedRow& row : printed_rows()) {
    const double share = row.indirect_side_px / 512.0;
    const double ms = 38.4 + row.samples * (0.085 + 0.773 * row.triangles / 1000.0 + 0.077 * share * share);
    EXPECT_NEAR(1000.0 / row.frames_per_s / ms, 1.0, 0.07) << "row " << row.number;
  }
}

TEST(PrintedTables, RowsAreSelected) {
  EXPECT_EQ(numbers_of("all").size(), 36u);
  EXPECT_TRUE(numbers_of("none").empty());
  EXPECT_THAT(numbers_of("7"), ElementsAre(7));
  EXPECT_THAT(numbers_of("36,4:6,5,1"), ElementsAre(1, 4, 5, 6, 36));
  for (const char* bad : {"", ",", "0", "37", "1,", "6:4", "a", "1:", ":3", "1:2:3", "1 2", "-1"}) {
    const auto rows = select_printed_rows(bad);
    ASSERT_FALSE(rows) << bad;
    EXPECT_THAT(rows.error().message(), HasSubstr("\"" + std::string(bad) + "\""));
  }
}

TEST(Measurement, MedianOfEachFigure) {
  const FrameCost a{30.0, {{"trace", 20.0}, {"gather", 5.0}}, 100}, b{10.0, {{"trace", 9.0}}, 300};
  const FrameCost c{20.0, {{"trace", 2.0}, {"gather", 3.0}}, 200};
  const FrameCost median = median_cost({a, b, c});
  EXPECT_EQ(median.ms, 20.0);
  EXPECT_EQ(median.rays, 200u);
  ASSERT_EQ(median.stages.size(), 2u);
  EXPECT_EQ(median.stages[0].name, "trace");
  EXPECT_EQ(median.stages[0].ms, 9.0);
  EXPECT_EQ(median.stages[1].ms, 3.0);  // of 5, 0 and 3
}

TEST(Measurement, MomentsCoverTheAnimationEvenly) {
  EXPECT_EQ(moment_s(0, 12.0), 0.0);
  EXPECT_EQ(moment_s(1, 12.0), 6.0);
  EXPECT_EQ(moment_s(2, 12.0), 3.0);
  EXPECT_EQ(moment_s(3, 12.0), 9.0);
  EXPECT_EQ(moment_s(5, 0.0), 0.0);
}

MeasuredRow measured(int number, double ms) {
  const PrintedRow printed = printed_rows()[static_cast<std::size_t>(number - 1)];
  return {printed, printed.indirect_side_px, {ms, {{"trace", ms / 2.0}}, 1'000'000}, 3};
}

ThesisBench example() {
  ThesisBench bench{"a device", "embree", 4, 512, 1, {measured(1, 50.0), measured(18, 1000.0)}, 32, 128, {}};
  bench.rows[1].median.stages.push_back({"gather", 100.0});
  bench.terrains = {{1458, 90.0, {80.0, {{"trace", 20.0}}, 500'000}, 3}, {5832, 95.0, {100.0, {}, 500'000}, 3}};
  return bench;
}

TEST(Measurement, RatesAreOfWhatIsResolvedAndWhatIsTraced) {
  const MeasuredRow row = measured(1, 50.0);  // 512 x 512 pixels, 32 samples
  EXPECT_DOUBLE_EQ(row.frames_per_s(), 20.0);
  EXPECT_DOUBLE_EQ(row.ratio(), 20.0 / 11.98);
  EXPECT_DOUBLE_EQ(row.rays_resolved_per_s(), 20.0 * 512 * 512 * 32);
  EXPECT_DOUBLE_EQ(row.rays_traced_per_s(), 20e6);
}

TEST(BenchReport, ColumnsAreAligned) {
  EXPECT_EQ(aligned({{"a", "long"}, {"123", "4"}}), "  a  long\n123     4\n");
}

TEST(BenchReport, TextHoldsRowsSummaryAndCost) {
  const std::string text = text_report(example());
  EXPECT_THAT(text, HasSubstr("a device"));
  EXPECT_THAT(text, HasSubstr("Table 6.1: helicopters, 1522 triangles"));
  EXPECT_EQ(text.find("Table 6.2"), std::string::npos);
  EXPECT_TRUE(std::regex_search(
      text, std::regex("\n *1 +32 +512x512 +11.98 +20.0 +1.67 +168 +20.0 +0.0000 +3 +50.0 +25.0 +-\n")))
      << text;
  EXPECT_THAT(text, HasSubstr("1 of 2 rows reach the printed figure; ratios from 0.70 (row 18) to 1.67 (row 1)"));
  EXPECT_TRUE(std::regex_search(text, std::regex("\n *5832 +100 +1.25 "))) << text;
}

TEST(BenchReport, BruteForceStandsBesideTheHierarchy) {
  ThesisBench bench = example();
  EXPECT_EQ(text_report(bench).find("brute force"), std::string::npos);
  bench.most_brute_triangles = 2000;
  bench.terrains[0].brute_force = FrameCost{900.0, {{"trace", 700.0}, {"candidates", 100.0}}, 500'000};
  const std::string text = text_report(bench);
  EXPECT_THAT(text, HasSubstr("up to 2000 triangles (--most-brute-triangles)"));
  EXPECT_TRUE(std::regex_search(text, std::regex("\n *1458 .* 20.0 +800 +1.00 "))) << text;
  EXPECT_TRUE(std::regex_search(text, std::regex("\n *5832 .* - +- "))) << text;
  const nlohmann::json json = json_report(bench);
  EXPECT_EQ(json["cost_against_triangles"][0]["brute_force"]["tracing_ms"], 800.0);
  EXPECT_FALSE(json["cost_against_triangles"][1].contains("brute_force"));
}

TEST(BenchReport, AnotherSizeIsSaidToBeUnlike) {
  ThesisBench bench = example();
  EXPECT_EQ(text_report(bench).find("unlike"), std::string::npos);
  bench.side_px = 64;
  EXPECT_THAT(text_report(bench), HasSubstr("unlike"));
}

TEST(BenchReport, JsonHoldsTheSame) {
  const nlohmann::json json = json_report(example());
  ASSERT_EQ(json.at("rows").size(), 2u);
  EXPECT_EQ(json["rows"][1].at("row"), 18);
  EXPECT_EQ(json["rows"][1].at("indirect_size"), 128);
  EXPECT_DOUBLE_EQ(json["rows"][1].at("ratio").get<double>(), 1.0 / 1.43);
  EXPECT_EQ(json["rows"][1].at("stages")[1].at("name"), "gather");
  EXPECT_EQ(json.at("cost_against_triangles")[1].at("triangles"), 5832);
}

TEST(BenchPlot, OnePlotForEachTableAndTheCost) {
  const std::vector<Plot> plots = plots_of(example());
  ASSERT_EQ(plots.size(), 2u);
  ASSERT_EQ(plots[0].curves.size(), 4u);  // two sizes of the indirect map, ours and the printed
  EXPECT_EQ(plots[0].curves[0].points.front(), glm::dvec2(32.0, 20.0));
  EXPECT_EQ(plots[0].curves[1].points.front(), glm::dvec2(32.0, 11.98));
  EXPECT_TRUE(plots[0].curves[1].dashed);
  EXPECT_EQ(plots[1].curves[0].points.size(), 2u);
  EXPECT_EQ(plots[1].curves[1].points.size(), 1u) << "no trace stage, no point";
}

TEST(SvgPlot, PlacesPointsOnLogarithmicAxes) {
  const Plot plot{"a < b", "x", "y", {1, 100}, {{"curve", "red", false, {{1.0, 1.0}, {10.0, 10.0}, {100.0, 100.0}}}}};
  const std::string svg = svg_of({plot});
  EXPECT_THAT(svg, HasSubstr("a &lt; b"));
  const std::regex circle("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::vector<glm::dvec2> places;
  for (std::sregex_iterator i(svg.begin(), svg.end(), circle), end; i != end; ++i)
    places.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
  ASSERT_EQ(places.size(), 3u);
  EXPECT_NEAR(places[1].x, (places[0].x + places[2].x) / 2.0, 0.01);
  EXPECT_NEAR(places[1].y, (places[0].y + places[2].y) / 2.0, 0.01);
  EXPECT_GT(places[0].y, places[2].y) << "y grows downward in SVG";
}

TEST(SvgPlot, TakesPlotsWithoutPoints) {
  const std::string svg = svg_of({Plot{"empty", "x", "y", {1, 10}, {}}});
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

double area_m2(const Scene& scene) {
  double area = 0.0;
  for (const Primitive& primitive : scene.meshes.at(0)->primitives)
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) { return primitive.positions[primitive.indices[i + k]]; };
      area += 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    }
  return area;
}

TEST(TessellatedTerrain, DivisionAddsTrianglesAndNoSurface) {
  const Scene coarse = make_tessellated_terrain(1), fine = make_tessellated_terrain(8);
  EXPECT_EQ(count_triangles(coarse), 1458u);
  EXPECT_EQ(count_triangles(fine), 64u * 1458u);
  EXPECT_NEAR(area_m2(fine) / area_m2(coarse), 1.0, 1e-4);
  const Pose a = pose_at(coarse, 0.0), b = pose_at(fine, 0.0);
  EXPECT_LT(glm::distance(a.bounds_min, b.bounds_min), 1e-4f);
  EXPECT_LT(glm::distance(a.bounds_max, b.bounds_max), 1e-4f);
}

TEST(TessellatedTerrain, FacesUpward) {
  const Scene scene = make_tessellated_terrain(2);
  for (const Primitive& primitive : scene.meshes.at(0)->primitives) {
    const auto corner = [&](std::size_t i) { return primitive.positions[primitive.indices[i]]; };
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3)
      ASSERT_GT(glm::cross(corner(i + 1) - corner(i), corner(i + 2) - corner(i)).y, 0.0f);
    for (const glm::vec3& normal : primitive.normals) {
      ASSERT_GT(normal.y, 0.0f);
      ASSERT_NEAR(glm::length(normal), 1.0f, 1e-4f);
    }
  }
}

TEST(FrameRequests, IndirectMapsKeepTheirShareOfThePicture) {
  EXPECT_EQ(scaled_indirect_side(128, 512), 128);
  EXPECT_EQ(scaled_indirect_side(128, kLeastSide_px), 8);
  for (const int side_px : {kLeastSide_px, kMostSide_px})
    for (const PrintedRow& row : printed_rows()) {
      Settings settings;
      settings.indirect_size = scaled_indirect_side(row.indirect_side_px, side_px);
      settings.samples = row.samples;
      EXPECT_TRUE(check_settings(settings, glm::ivec2(side_px)));
    }
}

}  // namespace
}  // namespace lightwell
