// The parts of `lightwell figures` that need no device: which pictures there are, and how a sheet is laid out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "renderer/image_io/label.h"
#include "server/command_line/thesis/figure_plan.h"
#include "server/command_line/thesis/figure_sheet.h"

namespace lightwell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<FigurePanel> panels_of(const Figure& figure) {
  std::vector<FigurePanel> panels;
  for (const auto& cell : figure.cells)
    if (cell) panels.push_back(*cell);
  return panels;
}

TEST(FigurePlan, EveryParameterOfTheTablesIsShownForBothScenes) {
  for (const char* scene : {"helicopters", "venus"}) {
    std::multiset<std::pair<int, int>> shown;
    int direct_only = 0;
    for (const Figure& figure : thesis_figures())
      if (figure.scene == scene && figure.number < "6.5")
        for (const FigurePanel& panel : panels_of(figure)) {
          if (panel.view == ViewKind::kDirect)
            ++direct_only;
          else
            shown.insert({panel.samples, panel.indirect_side_px});
        }
    EXPECT_EQ(direct_only, 1);
    EXPECT_EQ(shown.size(), 18u);
    for (const int samples : {32, 64, 96, 128, 256, 512})
      for (const int side_px : {512, 256, 128}) EXPECT_EQ(shown.count({samples, side_px}), 1u) << samples;
  }
}

TEST(FigurePlan, TheSeriesShowDirectIndirectAndBothAtEachMoment) {
  const std::vector<Figure> series = select_figures("6.5,6.6").value();
  for (const Figure& figure : series) {
    EXPECT_EQ(figure.columns, 3);
    const std::vector<FigurePanel> panels = panels_of(figure);
    ASSERT_EQ(panels.size(), 12u);
    for (std::size_t i = 0; i < panels.size(); i += 3) {
      EXPECT_EQ(panels[i].view, ViewKind::kDirect);
      EXPECT_EQ(panels[i + 1].view, ViewKind::kIndirect);
      EXPECT_EQ(panels[i + 2].view, ViewKind::kFinal);
      EXPECT_EQ(panels[i].time_s, panels[i + 2].time_s);
      EXPECT_EQ(panels[i + 2].samples, 128);
      EXPECT_EQ(panels[i + 2].indirect_side_px, 256);
    }
  }
}

TEST(FigurePlan, CellsFillTheirRowsAndFilesDiffer) {
  std::set<std::string> names;
  std::size_t count = 0;
  for (const Figure& figure : thesis_figures()) {
    EXPECT_EQ(figure.cells.size() % static_cast<std::size_t>(figure.columns), 0u);
    for (const FigurePanel& panel : panels_of(figure)) names.insert(figure.number + panel.name), ++count;
  }
  EXPECT_EQ(names.size(), count);
}

TEST(FigurePlan, FiguresAreSelected) {
  std::vector<std::string> numbers;
  const std::vector<Figure> some = select_figures("6.5,6.1").value();
  for (const Figure& figure : some) numbers.push_back(figure.number);
  EXPECT_THAT(numbers, ElementsAre("6.1", "6.5"));
  EXPECT_EQ(select_figures("all")->size(), 6u);
  for (const char* bad : {"", "6.7", "6", "6.1,", "6.1 6.2"}) EXPECT_FALSE(select_figures(bad)) << bad;
}

RgbImage plain(int side_px, std::uint8_t value) {
  return {glm::ivec2(side_px), std::vector<std::uint8_t>(static_cast<std::size_t>(3 * side_px * side_px), value)};
}

TEST(FigureSheet, ShrinkingKeepsTheMeanOfTheLight) {
  EXPECT_EQ(shrunk(plain(7, 93), 3).rgb, plain(3, 93).rgb);
  RgbImage checkers = plain(4, 0);
  for (std::size_t pixel = 0; pixel < 16; ++pixel)
    if ((pixel + pixel / 4) % 2 == 0)
      std::fill_n(checkers.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel), 3, 255);
  EXPECT_EQ(shrunk(checkers, 2).rgb, plain(2, 188).rgb);  // half the light is 188 of 255 in sRGB
}

TEST(FigureSheet, ShrinkingKeepsPlaces) {
  RgbImage image = plain(6, 0);
  image.rgb[3 * (1 * 6 + 4)] = 255;  // red in the upper right third
  const RgbImage small = shrunk(image, 3);
  for (std::size_t i = 0; i < small.rgb.size(); ++i) EXPECT_EQ(small.rgb[i] > 0, i == 3 * 2) << i;
}

Sheet example(int side_px) {
  Sheet sheet{"Title", 2, {}};
  sheet.cells = {CaptionedImage{plain(side_px, 50), "a"}, std::nullopt, CaptionedImage{plain(side_px, 100), "b"},
                 CaptionedImage{plain(side_px, 150), "c"}};
  return sheet;
}

TEST(FigureSheet, CellsDoNotOverlapAndLieWithin) {
  for (const int side_px : {8, 64, 512}) {
    const SheetLayout layout(example(side_px), side_px);
    EXPECT_EQ(layout.rows, 2);
    EXPECT_GE(layout.corner_px(1).x, layout.corner_px(0).x + side_px);
    EXPECT_GE(layout.corner_px(2).y, layout.corner_px(0).y + side_px + layout.font_px);
    EXPECT_LE(layout.corner_px(3).x + side_px, layout.size_px().x);
    EXPECT_LE(layout.corner_px(3).y + side_px + layout.font_px, layout.size_px().y);
  }
}

TEST(FigureSheet, TheLargestPanelJustFits) {
  const Sheet sheet = example(8);
  for (const glm::ivec2 most_px : {glm::ivec2(800, 900), glm::ivec2(900, 300)}) {
    const int panel_px = largest_panel(sheet, most_px);
    const auto fits = [&](int side_px) {
      return glm::all(glm::lessThanEqual(SheetLayout(sheet, side_px).size_px(), most_px));
    };
    EXPECT_TRUE(fits(panel_px));
    EXPECT_FALSE(fits(panel_px + 1));
  }
  EXPECT_EQ(largest_panel(sheet, {5, 5}), 1);
}

TEST(FigureSheet, PicturesStandInTheirCellsWithWordsBelow) {
  const Sheet sheet = example(64);
  const Result<RgbImage> image = composed(sheet, 32);
  ASSERT_TRUE(image) << image.error().message();
  const SheetLayout layout(sheet, 32);
  ASSERT_EQ(image->size_px, layout.size_px());
  const auto value_at = [&](glm::ivec2 place) {
    return image->rgb[3 * static_cast<std::size_t>(place.y * image->size_px.x + place.x)];
  };
  const std::array<int, 4> expected = {50, 255, 100, 150};
  for (std::size_t cell = 0; cell < 4; ++cell) {
    EXPECT_EQ(value_at(layout.corner_px(cell)), expected[cell]);
    EXPECT_EQ(value_at(layout.corner_px(cell) + 31), expected[cell]);
    int darkest = 255;
    for (int y = 0; y < layout.caption_px; ++y)
      for (int x = 0; x < 32; ++x)
        darkest = std::min<int>(darkest, value_at(layout.corner_px(cell) + glm::ivec2(x, 32 + y)));
    EXPECT_EQ(darkest < 128, cell != 1) << "a caption below every picture, and none elsewhere";
  }
}

TEST(Labels, LongerTextIsWiderAndOfOtherSizesRefused) {
  EXPECT_GT(*label_width("512 samples", 12), *label_width("512", 12));
  EXPECT_GT(*label_width("512", 24), *label_width("512", 12));
  std::vector<std::uint8_t> rgb(30);
  EXPECT_THAT(draw_label(rgb, {4, 4}, {0, 3}, "a", 8).error().message(), HasSubstr("4x4"));
}

}  // namespace
}  // namespace lightwell
