// Figures 6.1 to 6.6 of the thesis: which pictures they hold, and where.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/renderer.h"

namespace lightwell {

struct FigurePanel {
  std::string name;     // the end of its file's name: "32-samples-indirect-512"
  std::string caption;  // what stands below it
  double time_s = 0.0;
  ViewKind view = ViewKind::kFinal;
  int samples = 0;           // 0: no indirect light is found
  int indirect_side_px = 0;  // for a picture of kPrintedSide_px
};

struct Figure {
  std::string number;  // "6.1"
  std::string scene;   // a built-in one
  std::string title;
  int columns = 1;
  std::vector<std::optional<FigurePanel>> cells;  // row by row; an empty one stays white
};

/// All six, in order. 6.1 and 6.2 show `helicopters`, 6.3 and 6.4 `venus`, at each number of samples and size of the
/// indirect map that the tables have; 6.5 and 6.6 four moments of the two animations, with 128 samples and an indirect
/// map of 256 x 256.
std::vector<Figure> thesis_figures();

/// Those that `text` numbers, as in "6.1,6.5", or "all". The error's `where` is empty.
Result<std::vector<Figure>> select_figures(const std::string& text);

}  // namespace lightwell
