// A server under edits, uploads and reconnecting viewers for a while: whether its memory grows, requests fail, sessions
// get lost.
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <mutex>
#include <thread>

#include "tests/bench/program_options.h"
#include "tests/bench/report.h"
#include "tests/bench/stream_viewer.h"
#include "tests/integration/glb_writer.h"
#include "tests/integration/line.h"

namespace lightwell::bench {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr double kMostGrowthPercent = 2.0;
constexpr auto kSample = std::chrono::milliseconds(500);

/// What goes on, and what went wrong.
class Soak {
 public:
  explicit Soak(int port) : port_(port) {}

  std::atomic<bool> over = false;
  std::atomic<int> edits = 0, uploads = 0, reconnects = 0, errors = 0, lost_sessions = 0;

  std::string first_error() const {
    std::lock_guard lock(mutex_);
    return first_error_;
  }

  /// One session edited and looked at, again and again.
  void edit() {
    const std::string path = "/v1/sessions/" + make_session("cornell");
    for (int i = 0; !over; ++i) {
      const json edit{{"op", "replace"},
                      {"path", "/nodes/0/translation"},
                      {"value", {0.1 * std::sin(0.1 * i), 0.0, 0.1 * std::cos(0.1 * i)}}};
      expect(200, "PATCH", path, json{{"edits", {edit}}}.dump());
      expect(200, "GET", path + "/frame?format=jpeg");
      ++edits;
    }
    if (test::ask(port_, "GET", path).status != 200) ++lost_sessions;
  }

  /// A scene that comes, is rendered, and goes.
  void upload() {
    for (int i = 0; !over; ++i) {
      const std::string glb = test::triangle_glb(1 + i % 50);
      const test::Answer put = test::ask(port_, "PUT", "/v1/scenes/soak", glb, "model/gltf-binary");
      if (put.status != 201 && put.status != 200) fail("PUT", "/v1/scenes/soak", put);
      expect(200, "POST", "/v1/render", R"({"scene":"soak","width":64,"height":64,"settings":{"samples":4}})");
      expect(204, "DELETE", "/v1/scenes/soak");
      ++uploads;
    }
  }

  /// A viewer whose line breaks, and who comes back to the session it had.
  void reconnect() {
    const std::string session = make_session("helicopters");
    json resume = nullptr;
    while (!over) {
      test::WebSocketClient socket;
      const int status = socket.open(port_, "/v1/sessions/" + session + "/stream");
      if (status == 404) ++lost_sessions;
      if (status != 101) ++errors;
      if (status != 101) return;
      json hello{{"type", "hello"}, {"codecs", {"jpeg"}}, {"width", 128}, {"height", 128}, {"role", "driver"}};
      hello["resume"] = resume;
      socket.send_text(hello.dump());
      int frames = 0;
      while (frames < 5) {
        const auto message = socket.receive();
        if (!message) {
          ++errors;
          break;
        }
        if (!message->is_text) ++frames;
        const json text = message->is_text ? json::parse(message->bytes) : json::object();
        if (text.value("type", "") == "welcome") resume = text["resume"];
        if (text.value("type", "") == "error") ++errors;
        if (!message->is_text) socket.send_text(json{{"type", "ack"}, {"frame", frames}}.dump());
      }
      reconnects % 2 == 0 ? socket.cut() : socket.close();
      ++reconnects;
    }
  }

 private:
  std::string make_session(const std::string& scene) {
    const json request{{"scene", scene},
                       {"width", 128},
                       {"height", 128},
                       {"settings", {{"samples", 4}, {"indirect_size", 64}, {"bounces", 1}}}};
    const test::Answer answer = test::ask(port_, "POST", "/v1/sessions", request.dump());
    if (answer.status != 201) throw std::runtime_error("no session: " + answer.body);
    return json::parse(answer.body)["id"];
  }

  void expect(int status, const std::string& method, const std::string& target, const std::string& body = {}) {
    const test::Answer answer = test::ask(port_, method, target, body);
    if (answer.status != status) fail(method, target, answer);
  }

  void fail(const std::string& method, const std::string& target, const test::Answer& answer) {
    ++errors;
    std::lock_guard lock(mutex_);
    if (first_error_.empty())
      first_error_ = method + " " + target + ": " + std::to_string(answer.status) + " " + answer.body;
  }

  const int port_;
  mutable std::mutex mutex_;
  std::string first_error_;
};

double resident_megabytes(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  double all_pages = 0.0, resident_pages = 0.0;
  file >> all_pages >> resident_pages;
  return resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// The mean of the samples in a tenth of the time from `begin` on.
double level(const std::vector<double>& samples, std::size_t begin) {
  const std::size_t count = std::max<std::size_t>(samples.size() / 10, 1);
  begin = std::min(begin, samples.size() - count);
  double sum = 0.0;
  for (std::size_t i = begin; i < begin + count; ++i) sum += samples[i];
  return sum / static_cast<double>(count);
}

int run(const std::string& program, double minutes, bool as_json, bool check) {
  const int port = free_port();
  const ServerProcess server(program, port, {"--max-request-rate", "0"});
  server.wait_until_scenes_are_there();
  Viewer(port, false).next_frame();  // the shaders are there
  Soak soak(port);
  std::vector<std::thread> threads;
  threads.emplace_back([&] { soak.edit(); });
  threads.emplace_back([&] { soak.upload(); });
  threads.emplace_back([&] { soak.reconnect(); });
  threads.emplace_back([&] { soak.reconnect(); });
  std::vector<double> resident;
  const auto end = steady_clock::now() + std::chrono::duration<double, std::ratio<60>>(minutes);
  for (; steady_clock::now() < end; std::this_thread::sleep_for(kSample))
    resident.push_back(resident_megabytes(server.id()));
  soak.over = true;
  for (std::thread& thread : threads) thread.join();

  // From the end of the first minute on, or of the first third of a short run.
  const auto per_minute = static_cast<std::size_t>(std::chrono::minutes(1) / kSample);
  const double before = level(resident, std::min(per_minute, resident.size() / 3)),
               after = level(resident, resident.size());
  const double growth_percent = (after / before - 1.0) * 100.0;
  Report report;
  report.machine = {{"minutes", std::to_string(minutes)}};
  report.section("soak: edits, uploads, reconnects")
      .push_back({{},
                  {{"edits", soak.edits.load()},
                   {"uploads", soak.uploads.load()},
                   {"reconnects", soak.reconnects.load()},
                   {"errors", soak.errors.load()},
                   {"lost sessions", soak.lost_sessions.load()},
                   {"resident MB before", before},
                   {"after", after},
                   {"growth %", growth_percent}}});
  as_json ? print_json(report, std::cout) : print_table(report, std::cout);
  if (!soak.first_error().empty()) std::cerr << "first error: " << soak.first_error() << "\n";
  return check && (growth_percent > kMostGrowthPercent || soak.errors > 0 || soak.lost_sessions > 0) ? 1 : 0;
}

}  // namespace
}  // namespace lightwell::bench

int main(int count, char** arguments) {
  using namespace lightwell::bench;
  double minutes = 10.0;
  return bench_main(count, arguments, "Edits, uploads and reconnections for minutes: memory, errors, lost sessions",
                    {{"--minutes", minutes}},
                    [&](const ProgramOptions& o) { return run(o.program, minutes, o.as_json, o.check); });
}
