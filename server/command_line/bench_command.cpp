#include "server/command_line/bench_command.h"

#include <CLI/CLI.hpp>

namespace lightwell {

void add_bench_options(CLI::App& app, BenchArguments& arguments) {
  app.require_subcommand(1);
  add_bench_thesis_options(*app.add_subcommand("thesis", "Measure the thesis' tables 6.1 and 6.2 on this machine"),
                           arguments.thesis);
}

ExitCode run_bench(const CLI::App&, const BenchArguments& arguments) {
  return run_bench_thesis(arguments.thesis);
}

}  // namespace lightwell
