// Tables 6.1 and 6.2 of the thesis: frames a second on a GeForce GTX 280 in 2009, by scene, samples and indirect map.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/error.h"

namespace lightwell {

/// The side of the pictures that were measured, in pixels.
constexpr int kPrintedSide_px = 512;

struct PrintedRow {
  int number = 0;  // 1..36, counted through both tables
  std::string_view table;
  std::string_view scene;  // the built-in scene that stands for the model
  int triangles = 0;
  int samples = 0;           // directions per pixel of the indirect map
  int indirect_side_px = 0;  // of the indirect map, for a picture of kPrintedSide_px
  double frames_per_s = 0.0;
};

/// All 36 rows, in the order of print.
std::span<const PrintedRow> printed_rows();

/// The rows that `text` names: "all", "none", or numbers and ranges as in "1,4:6,36". Each comes once, in the order of
/// print. The error's `where` is empty.
Result<std::vector<PrintedRow>> select_printed_rows(const std::string& text);

}  // namespace lightwell
