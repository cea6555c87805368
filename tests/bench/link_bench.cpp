// A viewer behind a slow link who drags and then stops: how late the pictures are, and when the sharp one comes.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>

#include "tests/bench/program_options.h"
#include "tests/bench/report.h"
#include "tests/bench/slow_link.h"
#include "tests/bench/stream_viewer.h"

namespace lightwell::bench {
namespace {

constexpr double kMostLatencyMs = 400.0;  // at p95
constexpr double kInputEveryMs = 33.0;
constexpr double kLearningMs = 2000.0;  // the link is not known before

struct Figures {
  std::vector<double> latency_ms, kilobytes;
  double frames_per_s = 0.0, final_s = 0.0, final_kilobytes = 0.0;
  int narrowest_px = 1 << 16;
  bool sharp = false;  // the last picture: whole, and final
};

/// Drags for so long, an input as often as a hand gives one, and then lets go.
Figures drag(Viewer& viewer, double seconds) {
  Figures figures;
  std::map<std::uint32_t, double> sent_ms;
  const double start_ms = now_ms(), end_ms = start_ms + seconds * 1e3;
  double next_input_ms = start_ms, last_ms = start_ms;
  while (now_ms() < end_ms) {
    for (; next_input_ms <= now_ms(); next_input_ms += kInputEveryMs) {
      const double at_ms = now_ms();
      sent_ms[viewer.send_camera()] = at_ms;
    }
    const auto until_input = std::chrono::milliseconds(std::max<long>(std::lround(next_input_ms - now_ms()), 0));
    const auto frame = viewer.frame_within(until_input);
    if (!frame) continue;
    const Viewer::Seen seen = *frame;
    const bool counts = seen.arrived_ms - start_ms > kLearningMs;
    while (!sent_ms.empty() && sent_ms.begin()->first <= seen.header.input_seq) {
      if (counts) figures.latency_ms.push_back(seen.arrived_ms - sent_ms.begin()->second);
      sent_ms.erase(sent_ms.begin());
    }
    if (counts) figures.kilobytes.push_back(seen.header.payload_bytes / 1e3);
    figures.narrowest_px = std::min<int>(figures.narrowest_px, seen.header.width);
    last_ms = seen.arrived_ms;
  }
  figures.frames_per_s = static_cast<double>(figures.kilobytes.size()) / (last_ms - start_ms - kLearningMs) * 1e3;
  Viewer::Seen seen = viewer.next_frame();
  while (!seen.header.is_final) seen = viewer.next_frame();
  figures.final_s = (seen.arrived_ms - end_ms) / 1e3;
  figures.final_kilobytes = seen.header.payload_bytes / 1e3;
  figures.sharp = seen.header.width == 512 && seen.header.height == 512;
  return figures;
}

int run(const std::string& program, double megabits, double round_trip_ms, double seconds, bool as_json, bool check) {
  const int port = free_port();
  const ServerProcess server(program, port);
  server.wait_until_scenes_are_there();
  const SlowLink link(port, megabits * 1e6, round_trip_ms);
  Viewer viewer(link.port(), false);
  for (int i = 0; i < 3; ++i) viewer.move_camera();
  const Figures figures = drag(viewer, seconds);
  const double p95_ms = share_below(figures.latency_ms, 0.95);
  Report report;
  report.machine = {{"link", std::to_string(megabits) + " Mb/s, " + std::to_string(round_trip_ms) + " ms"}};
  report.section("a drag over a slow link, helicopters 512x512")
      .push_back({{{"seconds", std::to_string(seconds)}},
                  {{"latency ms", median(figures.latency_ms)},
                   {"latency ms p95", p95_ms},
                   {"frames/s", figures.frames_per_s},
                   {"kB/frame", median(figures.kilobytes)},
                   {"narrowest px", static_cast<double>(figures.narrowest_px)},
                   {"final after s", figures.final_s},
                   {"final kB", figures.final_kilobytes}}});
  as_json ? print_json(report, std::cout) : print_table(report, std::cout);
  return check && (p95_ms > kMostLatencyMs || !figures.sharp) ? 1 : 0;
}

}  // namespace
}  // namespace lightwell::bench

int main(int count, char** arguments) {
  using namespace lightwell::bench;
  double megabits = 4.0, round_trip_ms = 100.0, seconds = 12.0;
  return bench_main(
      count, arguments, "A stream over a slow link",
      {{"--megabits", megabits}, {"--round-trip-ms", round_trip_ms}, {"--seconds", seconds}},
      [&](const ProgramOptions& o) { return run(o.program, megabits, round_trip_ms, seconds, o.as_json, o.check); });
}
