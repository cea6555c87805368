// `lightwell bench quality`: error against time, of every method on the built-in scenes.
#pragma once

#include <string>

#include "server/command_line/exit_code.h"
#include "server/command_line/quality_table.h"

namespace CLI {
class App;
}

namespace lightwell {

struct BenchQualityArguments {
  QualityPlan plan;
  std::string plot;  // an .svg; empty: none
  std::string json;  // a .json; empty: none
  std::string device, tracer;
};

void add_bench_quality_options(CLI::App& quality, BenchQualityArguments& arguments);

/// Throws gl::NoDevice, or std::runtime_error when the renderer cannot start.
ExitCode run_bench_quality(const BenchQualityArguments& arguments);

}  // namespace lightwell
