// `lightwell bench thesis`: the thesis' tables 6.1 and 6.2 measured here, and the cost against the number of triangles.
#pragma once

#include <string>
#include <vector>

#include "renderer/renderer.h"
#include "server/command_line/exit_code.h"
#include "server/command_line/thesis/printed_tables.h"

namespace CLI {
class App;
}

namespace lightwell {

/// The thesis' framework with the patches that pay best.
inline Settings with_patches() {
  Settings settings;
  settings.patch = 8;
  return settings;
}

struct BenchThesisArguments {
  std::vector<PrintedRow> rows{printed_rows().begin(), printed_rows().end()};
  int most_triangles = 1'500'000;    // of the terrain; 0: it is not measured
  int most_brute_triangles = 6'000;  // up to these brute force is measured as well; 0: not at all
  int side_px = kPrintedSide_px;
  int most_frames = 9;                 // per row
  double budget_s = 20.0;              // per row, with its warm-up; one frame is measured in any case
  std::string json, plot;              // files; empty: none
  Settings settings = with_patches();  // samples and indirect_size are the row's
  std::string device, tracer;
};

void add_bench_thesis_options(CLI::App& app, BenchThesisArguments& arguments);

/// Throws gl::NoDevice, or std::runtime_error when the renderer cannot start.
ExitCode run_bench_thesis(const BenchThesisArguments& arguments);

}  // namespace lightwell
