// The server end to end, as a client on loopback sees it: a process of its own, a real socket, no decoding.
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <thread>

#include "tests/bench/program_options.h"
#include "tests/bench/report.h"
#include "tests/bench/stream_viewer.h"

namespace lightwell::bench {
namespace {

constexpr double kLeastFramesPerSecond = 15.0;
constexpr double kMostAddedMs = 5.0;
constexpr double kMostStartSeconds = 3.0;

void measure_rate(int port, const std::string& method, int patch, double seconds, Report& report) {
  Viewer viewer(port, true, patch, method);
  for (int i = 0; i < 20; ++i) viewer.next_frame();
  std::vector<double> added_ms, render_ms, kilobytes;
  const double start_ms = now_ms();
  double end_ms = start_ms;
  while (end_ms - start_ms < seconds * 1e3) {
    const Viewer::Seen seen = viewer.next_frame();
    added_ms.push_back(seen.added_ms());
    render_ms.push_back(static_cast<double>(seen.header.render_ms));
    kilobytes.push_back(seen.header.payload_bytes / 1e3);
    end_ms = seen.arrived_ms;
  }
  report.section("helicopters 512x512, 32 samples, indirect 128x128, 1 bounce")
      .push_back({{{"method", method}, {"patch", std::to_string(patch)}},
                  {{"frames/s", static_cast<double>(added_ms.size()) / (end_ms - start_ms) * 1e3},
                   {"render ms", median(render_ms)},
                   {"added ms", median(added_ms)},
                   {"added ms p95", share_below(added_ms, 0.95)},
                   {"encode ms", median(viewer.encode_ms())},
                   {"kB/frame", median(kilobytes)}}});
}

void measure_latency(int port, bool playing, int moves, Report& report) {
  Viewer viewer(port, playing);
  for (int i = 0; i < 5; ++i) viewer.move_camera();
  std::vector<double> latency_ms, over_render_ms, added_ms;
  std::pair<double, Viewer::Seen> slowest;
  for (int i = 0; i < moves; ++i) {
    const auto [ms, seen] = viewer.move_camera();
    if (ms > slowest.first) slowest = {ms, seen};
    latency_ms.push_back(ms);
    over_render_ms.push_back(ms - static_cast<double>(seen.header.render_ms));
    added_ms.push_back(seen.added_ms());
  }
  report.section("input to picture")
      .push_back({{{"playing", playing ? "yes" : "no"}},
                  {{"ms", median(latency_ms)},
                   {"ms p99", share_below(latency_ms, 0.99)},
                   {"over render ms", median(over_render_ms)},
                   {"over render ms p99", share_below(over_render_ms, 0.99)},
                   {"added ms", median(added_ms)},
                   {"slowest: ms", slowest.first},
                   {"its render ms", static_cast<double>(slowest.second.header.render_ms)},
                   {"its added ms", slowest.second.added_ms()}}});
}

double figure(Report& report, const std::string& section, const std::string& name) {
  for (const auto& [figure_name, value] : report.section(section).front().figures)
    if (figure_name == name) return value;
  throw std::logic_error("no figure " + name);
}

bool good_enough(Report& report) {
  const std::string rate = "helicopters 512x512, 32 samples, indirect 128x128, 1 bounce";
  return figure(report, rate, "frames/s") >= kLeastFramesPerSecond &&
         figure(report, rate, "added ms") <= kMostAddedMs &&
         figure(report, "start", "first frame s") <= kMostStartSeconds;
}

int run(const std::string& program, double seconds, bool as_json, bool check) {
  const int port = free_port();
  Report report;
  const double start_ms = now_ms();
  const ServerProcess server(program, port);
  server.wait_until_scenes_are_there();
  const double scenes_ms = now_ms();
  const double first_ms = Viewer(port, true, 1, "realtime").next_frame().arrived_ms;
  report.machine = {{"threads", std::to_string(std::thread::hardware_concurrency())},
                    {"seconds", std::to_string(seconds)}};
  report.section("start").push_back(
      {{{"process", "cold"}},
       {{"scenes s", (scenes_ms - start_ms) / 1e3}, {"first frame s", (first_ms - start_ms) / 1e3}}});
  for (const int patch : {2, 1, 4}) measure_rate(port, "thesis", patch, seconds, report);
  measure_rate(port, "realtime", 1, seconds, report);
  measure_latency(port, true, 100, report);
  measure_latency(port, false, 100, report);
  as_json ? print_json(report, std::cout) : print_table(report, std::cout);
  return check && !good_enough(report) ? 1 : 0;
}

}  // namespace
}  // namespace lightwell::bench

int main(int count, char** arguments) {
  using namespace lightwell::bench;
  double seconds = 10.0;
  return bench_main(count, arguments, "Frames a second and latency of a stream on loopback", {{"--seconds", seconds}},
                    [&](const ProgramOptions& o) { return run(o.program, seconds, o.as_json, o.check); });
}
