// The program `lightwell`: serve, render, devices, compare, bench, figures.
#pragma once

namespace lightwell {

/// Parses, runs, and returns the process's exit code (see exit_code.h). Never throws.
int run_command_line(int argc, char** argv);

}  // namespace lightwell
