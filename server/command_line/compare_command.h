// `lightwell compare A B`: how far picture A is from the reference B.
#pragma once

#include <string>

#include "server/command_line/exit_code.h"

namespace CLI {
class App;
}

namespace lightwell {

struct CompareArguments {
  std::string picture, reference;
  std::string heatmap;  // a .png or .jpg; empty: none
  bool json = false;
};

void add_compare_options(CLI::App& app, CompareArguments& arguments);

ExitCode run_compare(const CompareArguments& arguments);

}  // namespace lightwell
