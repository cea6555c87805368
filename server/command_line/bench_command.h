// `lightwell bench ...`: measurements, each a command below it.
#pragma once

#include "server/command_line/bench_quality_command.h"
#include "server/command_line/bench_thesis_command.h"
#include "server/command_line/exit_code.h"

namespace lightwell {

struct BenchArguments {
  BenchThesisArguments thesis;
  BenchQualityArguments quality;
};

void add_bench_options(CLI::App& app, BenchArguments& arguments);

/// Runs the command that `app` parsed.
ExitCode run_bench(const CLI::App& app, const BenchArguments& arguments);

}  // namespace lightwell
