#include "server/command_line/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "renderer/gl/device.h"
#include "server/command_line/bench_command.h"
#include "server/command_line/compare_command.h"
#include "server/command_line/devices_command.h"
#include "server/command_line/figures_command.h"
#include "server/command_line/render_command.h"
#include "server/command_line/serve_command.h"

namespace lightwell {

namespace {

struct Arguments {
  ServeOptions serve;
  RenderArguments render;
  DevicesArguments devices;
  CompareArguments compare;
  BenchArguments bench;
  FiguresArguments figures;
};

constexpr const char* kFooter =
    "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 bad input, 4 no usable device.\n"
    "`lightwell COMMAND --help` lists a command's options.";

int parse_and_run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Lightwell: interactive global illumination for glTF scenes, headless, streamed to browsers.",
               "lightwell");
  app.set_version_flag("--version", "lightwell " LIGHTWELL_VERSION);
  app.require_subcommand(1);
  app.footer(kFooter);
  app.get_formatter()->column_width(34);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return "lightwell: " + std::string(error.what()) + "\nRun with --help for more information.\n";
  });
  CLI::App& serve_app = *app.add_subcommand("serve", "Serve a scene over HTTP and WebSocket");
  CLI::App& render_app = *app.add_subcommand("render", "Render pictures to files");
  CLI::App& devices_app =
      *app.add_subcommand("devices", "List the OpenGL devices and say which one is chosen, and why");
  CLI::App& compare_app = *app.add_subcommand("compare", "Measure how far picture A is from the reference B");
  CLI::App& bench_app = *app.add_subcommand("bench", "Measure this machine");
  CLI::App& figures_app = *app.add_subcommand("figures", "Make the thesis' figures 6.1 to 6.6 anew");
  add_serve_options(serve_app, arguments.serve);
  add_render_options(render_app, arguments.render);
  add_devices_options(devices_app, arguments.devices);
  add_compare_options(compare_app, arguments.compare);
  add_bench_options(bench_app, arguments.bench);
  add_figures_options(figures_app, arguments.figures);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongUsage;
  }
  if (serve_app.parsed()) return serve(arguments.serve);
  if (render_app.parsed()) return run_render(arguments.render);
  if (devices_app.parsed()) return run_devices(arguments.devices);
  if (compare_app.parsed()) return run_compare(arguments.compare);
  if (bench_app.parsed()) return run_bench(bench_app, arguments.bench);
  return run_figures(arguments.figures);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  gl::share_processors_evenly();
  try {
    return parse_and_run(argc, argv);
  } catch (const gl::NoDevice& error) {
    std::fprintf(stderr, "lightwell: %s\n", error.what());
    return kNoUsableDevice;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lightwell: %s\n", error.what());
    return kFailed;
  }
}

}  // namespace lightwell
