#include "server/command_line/bench_command.h"

#include <CLI/CLI.hpp>

namespace lightwell {

void add_bench_options(CLI::App& app, BenchArguments& arguments) {
  app.require_subcommand(1);
  add_bench_thesis_options(*app.add_subcommand("thesis", "Measure the thesis' tables 6.1 and 6.2 on this machine"),
                           arguments.thesis);
  add_bench_quality_options(
      *app.add_subcommand("quality",
                          "Error against milliseconds: every method at several settings, against a converged "
                          "picture by reference"),
      arguments.quality);
}

ExitCode run_bench(const CLI::App& app, const BenchArguments& arguments) {
  if (app.got_subcommand("quality")) return run_bench_quality(arguments.quality);
  return run_bench_thesis(arguments.thesis);
}

}  // namespace lightwell
