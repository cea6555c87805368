// The server end to end, as a client on loopback sees it: a process of its own, a real socket, no decoding.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <thread>

#include "protocol/codec.h"
#include "protocol/frame_header.h"
#include "tests/bench/report.h"
#include "tests/integration/line.h"
#include "tests/integration/stream_client.h"

namespace lightwell::bench {
namespace {

using nlohmann::json;
using protocol::FrameHeader;
using std::chrono::steady_clock;

constexpr double kLeastFramesPerSecond = 15.0;
constexpr double kMostAddedMs = 5.0;
constexpr double kMostStartSeconds = 3.0;

double now_ms() {
  return std::chrono::duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

double share_below(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// `lightwell serve` as a child, stopped when this goes.
class ServerProcess {
 public:
  ServerProcess(const std::string& program, int port) {
    const std::string port_text = std::to_string(port);
    child_ = ::fork();
    if (child_ == 0) {
      const int nowhere = ::open("/dev/null", O_WRONLY);
      ::dup2(nowhere, STDOUT_FILENO);
      ::dup2(nowhere, STDERR_FILENO);
      ::execl(program.c_str(), program.c_str(), "serve", "builtin:helicopters", "--port", port_text.c_str(), nullptr);
      ::_exit(127);
    }
  }
  ~ServerProcess() {
    ::kill(child_, SIGTERM);
    ::waitpid(child_, nullptr, 0);
  }
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  void check() const {
    if (::waitpid(child_, nullptr, WNOHANG) != 0) throw std::runtime_error("the server ended by itself");
  }

 private:
  pid_t child_ = -1;
};

/// A stream of a session of its own, which acknowledges every frame at once.
class Viewer {
 public:
  struct Seen {
    FrameHeader header;
    double arrived_ms = 0.0;
    /// Everything but rendering: waiting for an encoder, encoding, the socket, the client's loop.
    double added_ms() const { return arrived_ms - header.capture_ms - static_cast<double>(header.render_ms); }
  };

  Viewer(int port, bool playing) {
    const json request{{"scene", "helicopters"},
                       {"width", 512},
                       {"height", 512},
                       {"playing", playing},
                       {"time_s", 3.0},
                       {"settings", {{"samples", 32}, {"indirect_size", 128}, {"bounces", 1}, {"denoise", false}}}};
    const test::Answer answer = test::ask(port, "POST", "/v1/sessions", request.dump());
    if (answer.status != 201) throw std::runtime_error("no session: " + answer.body);
    socket_.open(port, "/v1/sessions/" + json::parse(answer.body)["id"].get<std::string>() + "/stream");
    protocol::Hello hello;
    hello.codecs = {"jpeg"};
    hello.width = hello.height = 512;
    send(hello);
  }

  Seen next_frame() {
    for (;;) {
      const auto message = socket_.receive(std::chrono::seconds(30));
      const double arrived_ms = now_ms();
      if (!message) throw std::runtime_error("the stream ended: " + socket_.close_reason());
      if (message->is_text) {
        hear(message->bytes);
        continue;
      }
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(message->bytes.data());
      const auto frame = protocol::decode_frame({bytes, message->bytes.size()});
      if (!frame) throw std::runtime_error(frame.problem().detail);
      protocol::Ack ack;
      ack.frame = frame->header.frame;
      send(ack);
      return {frame->header, arrived_ms};
    }
  }

  /// Moves the camera; milliseconds until a picture of it is here, and that picture.
  std::pair<double, Seen> move_camera() {
    protocol::Input input;
    input.seq = ++seq_;
    protocol::FreeCamera camera;
    camera.eye = {10.0 + 0.01 * seq_, 6.0, 14.0};
    camera.target = {0.0, 2.0, 0.0};
    input.change.camera = camera;
    const double sent_ms = now_ms();
    send(input);
    for (;;) {
      const Seen seen = next_frame();
      if (seen.header.input_seq >= seq_) return {seen.arrived_ms - sent_ms, seen};
    }
  }

  const std::vector<double>& encode_ms() const { return encode_ms_; }

 private:
  void send(const protocol::ClientMessage& message) { socket_.send_text(protocol::serialize(message)); }

  void hear(const std::string& text) {
    const json message = json::parse(text);
    if (message["type"] == "stats") encode_ms_.push_back(message["encode_ms"]);
    if (message["type"] == "error") throw std::runtime_error(text);
  }

  test::WebSocketClient socket_;
  std::uint32_t seq_ = 0;
  std::vector<double> encode_ms_;
};

int free_port() {
  // Taken and given back: nobody else on this machine asks for ports as quickly.
  const int probe = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ::bind(probe, reinterpret_cast<const sockaddr*>(&address), size);
  ::getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(probe);
  return ntohs(address.sin_port);
}

void wait_until_scenes_are_there(const ServerProcess& server, int port) {
  for (;;) {
    server.check();
    try {
      if (test::ask(port, "GET", "/v1/scenes").status == 200) return;
    } catch (const std::runtime_error&) {  // does not listen yet
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

void measure_rate(int port, double seconds, Report& report) {
  Viewer viewer(port, true);
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
      .push_back({{{"playing", "yes"}},
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
  wait_until_scenes_are_there(server, port);
  const double scenes_ms = now_ms();
  const double first_ms = Viewer(port, true).next_frame().arrived_ms;
  report.machine = {{"threads", std::to_string(std::thread::hardware_concurrency())},
                    {"seconds", std::to_string(seconds)}};
  report.section("start").push_back(
      {{{"process", "cold"}},
       {{"scenes s", (scenes_ms - start_ms) / 1e3}, {"first frame s", (first_ms - start_ms) / 1e3}}});
  measure_rate(port, seconds, report);
  measure_latency(port, true, 100, report);
  measure_latency(port, false, 100, report);
  as_json ? print_json(report, std::cout) : print_table(report, std::cout);
  return check && !good_enough(report) ? 1 : 0;
}

}  // namespace
}  // namespace lightwell::bench

int main(int count, char** arguments) {
  std::string program = LIGHTWELL_PROGRAM;
  double seconds = 10.0;
  bool as_json = false, check = false;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--json") {
      as_json = true;
    } else if (argument == "--check") {
      check = true;
    } else if (argument == "--program" && i + 1 < count) {
      program = arguments[++i];
    } else if (argument == "--seconds" && i + 1 < count) {
      seconds = std::atof(arguments[++i]);
    } else {
      std::cerr << "usage: stream_bench [--json] [--check] [--seconds N] [--program lightwell]\n";
      return 2;
    }
  }
  try {
    return lightwell::bench::run(program, seconds, as_json, check);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
