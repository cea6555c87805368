// The command line of the benchmarks that drive the program as a process.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <initializer_list>
#include <string>

namespace lightwell::bench {

struct ProgramOptions {
  std::string program = LIGHTWELL_PROGRAM;
  bool as_json = false;
  bool check = false;  // exit with 1 if a figure misses its aim
};

/// "--minutes" and the like, with what it is unless given.
struct NumberOption {
  std::string name;
  double& value;
};

/// A benchmark's `main`: reads the options and runs it. 2: wrong usage; 1: it failed.
inline int bench_main(int count, char** arguments, const std::string& what, std::initializer_list<NumberOption> numbers,
                      const std::function<int(const ProgramOptions&)>& run) {
  ProgramOptions options;
  CLI::App app(what);
  app.add_flag("--json", options.as_json, "Print JSON");
  app.add_flag("--check", options.check, "Exit with 1 if a figure misses its aim");
  app.add_option("--program", options.program, "The lightwell to measure");
  for (const NumberOption& number : numbers)
    app.add_option(number.name, number.value)->check(CLI::PositiveNumber)->capture_default_str();
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace lightwell::bench
