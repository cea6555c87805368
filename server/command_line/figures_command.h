// `lightwell figures DIR`: figures 6.1 to 6.6 of the thesis, made anew.
#pragma once

#include <string>
#include <vector>

#include "server/command_line/exit_code.h"
#include "server/command_line/thesis/figure_plan.h"
#include "server/command_line/thesis/printed_tables.h"

namespace CLI {
class App;
}

namespace lightwell {

struct FiguresArguments {
  std::string folder;
  std::vector<Figure> figures = thesis_figures();
  int side_px = kPrintedSide_px;
  Settings settings;  // samples, indirect_size, view and exposure are the figure's
  std::string device, tracer;
};

void add_figures_options(CLI::App& app, FiguresArguments& arguments);

/// Throws gl::NoDevice, or std::runtime_error when the renderer cannot start.
ExitCode run_figures(const FiguresArguments& arguments);

}  // namespace lightwell
