// Many at once: watchers of one session, sessions side by side, connections that do nothing. The server and its clients
// share this process and its cores, so the figures are of both.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <thread>

#include "protocol/codec.h"
#include "protocol/frame_header.h"
#include "server/running_server.h"
#include "tests/bench/report.h"
#include "tests/integration/line.h"
#include "tests/integration/stream_client.h"

namespace lightwell::bench {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr int kWatchers = 64, kSessions = 8, kIdle = 1000;

std::string make_session(int port, int samples = 8, int indirect_size = 32) {
  const json settings{
      {"method", "thesis"}, {"samples", samples}, {"indirect_size", indirect_size}, {"bounces", 1}, {"denoise", false}};
  const json request{{"scene", "helicopters"}, {"width", 128}, {"height", 128}, {"settings", settings}};
  const test::Answer answer = test::ask(port, "POST", "/v1/sessions", request.dump());
  if (answer.status != 201) throw std::runtime_error("no session: " + answer.body);
  return json::parse(answer.body)["id"];
}

/// A stream in a thread of its own, which acknowledges every frame at once and counts those of the measured time.
class Viewer {
 public:
  Viewer(int port, const std::string& session, protocol::Role role) {
    socket_.open(port, "/v1/sessions/" + session + "/stream");
    protocol::Hello hello;
    hello.codecs = {"jpeg"};
    hello.width = hello.height = 128;
    hello.role = role;
    socket_.send_text(protocol::serialize(protocol::ClientMessage(hello)));
    thread_ = std::thread([this] { watch(); });
  }
  ~Viewer() {
    stop_ = true;
    thread_.join();
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void restart() { frames_ = 0; }
  int frames() const { return frames_; }

 private:
  void watch() {
    while (!stop_) {
      const auto message = socket_.receive(std::chrono::milliseconds(200));
      if (!message || message->is_text) continue;
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(message->bytes.data());
      const auto frame = protocol::decode_frame({bytes, message->bytes.size()});
      if (!frame) continue;
      protocol::Ack ack;
      ack.frame = frame->header.frame;
      socket_.send_text(protocol::serialize(protocol::ClientMessage(ack)));
      ++frames_;
    }
  }

  test::WebSocketClient socket_;
  std::atomic<int> frames_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

using Viewers = std::vector<std::unique_ptr<Viewer>>;

/// Frames a second of each viewer, after a second to get going.
std::vector<double> rates_of(const Viewers& viewers, double seconds) {
  std::this_thread::sleep_for(std::chrono::seconds(1));
  for (const auto& viewer : viewers) viewer->restart();
  const auto start = steady_clock::now();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const double took = std::chrono::duration<double>(steady_clock::now() - start).count();
  std::vector<double> rates;
  for (const auto& viewer : viewers) rates.push_back(viewer->frames() / took);
  return rates;
}

double metric(int port, const std::string& name) {
  const std::string text = test::ask(port, "GET", "/metrics").body;
  const auto at = text.find("\n" + name + " ");
  return at == std::string::npos ? 0.0 : std::atof(text.c_str() + at + name.size() + 2);
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

void measure_watchers(int port, double seconds, Report& report) {
  const std::string session = make_session(port);
  Viewers viewers;
  for (int i = 0; i <= kWatchers; ++i)
    viewers.push_back(std::make_unique<Viewer>(port, session, i ? protocol::Role::kViewer : protocol::Role::kDriver));
  const auto encoded_so_far = [port] { return metric(port, "lightwell_pictures_encoded_total{codec=\"jpeg\"}"); };
  const auto sent_so_far = [port] { return metric(port, "lightwell_pictures_sent_total{codec=\"jpeg\"}"); };
  rates_of(viewers, 0.5);  // all are there
  const double encoded_before = encoded_so_far(), sent_before = sent_so_far();
  const std::vector<double> rates = rates_of(viewers, seconds);
  const double encoded = encoded_so_far() - encoded_before, sent = sent_so_far() - sent_before;
  report.section("64 watchers of one session")
      .push_back({{{"size", "128x128"}},
                  {{"driver frames/s", rates.front()},
                   {"slowest watcher's share", *std::min_element(rates.begin(), rates.end()) / rates.front()},
                   {"sent per encoded", sent / std::max(encoded, 1.0)}}});
  viewers.clear();
  test::ask(port, "DELETE", "/v1/sessions/" + session);
}

void measure_sessions(int port, double seconds, Report& report) {
  std::vector<std::string> sessions;
  Viewers viewers;
  const auto add = [&] {
    sessions.push_back(make_session(port));
    viewers.push_back(std::make_unique<Viewer>(port, sessions.back(), protocol::Role::kDriver));
  };
  add();
  const double alone = rates_of(viewers, seconds).front();
  while (static_cast<int>(sessions.size()) < kSessions) add();
  const std::vector<double> rates = rates_of(viewers, seconds);
  const double mean = sum(rates) / kSessions;
  report.section("8 sessions at once")
      .push_back({{{"size", "128x128"}},
                  {{"alone frames/s", alone},
                   {"together frames/s", sum(rates)},
                   {"together/alone", sum(rates) / alone},
                   {"slowest/mean", *std::min_element(rates.begin(), rates.end()) / mean}}});
  viewers.clear();
  for (const std::string& session : sessions) test::ask(port, "DELETE", "/v1/sessions/" + session);
}

/// A session of small pictures beside one whose pictures take many times as long: half of the time is its share.
void measure_light_beside_heavy(int port, double seconds, Report& report) {
  const std::string light = make_session(port), heavy = make_session(port, 128, 128);
  const auto alone_rate = [&](const std::string& session) {
    Viewers alone;
    alone.push_back(std::make_unique<Viewer>(port, session, protocol::Role::kDriver));
    rates_of(alone, 1.0);  // its first pictures may need shaders
    return rates_of(alone, seconds).front();
  };
  const double light_alone = alone_rate(light), heavy_alone = alone_rate(heavy);
  Viewers both;
  for (const std::string& session : {light, heavy})
    both.push_back(std::make_unique<Viewer>(port, session, protocol::Role::kDriver));
  const std::vector<double> rates = rates_of(both, seconds);
  report.section("a light session beside a heavy one")
      .push_back({{{"size", "128x128"}},
                  {{"light alone frames/s", light_alone},
                   {"heavy alone frames/s", heavy_alone},
                   {"light beside it frames/s", rates[0]},
                   {"light beside/alone", rates[0] / light_alone},
                   {"heavy beside/alone", rates[1] / heavy_alone}}});
  both.clear();
  for (const std::string& session : {light, heavy}) test::ask(port, "DELETE", "/v1/sessions/" + session);
}

void measure_idle(int port, Report& report) {
  std::vector<test::Line> lines;
  for (int i = 0; i < kIdle; ++i) {
    lines.emplace_back(port);
    if (i % 2) lines.back().send("GET /v1/scenes HTTP/1.1\r\nHos");
  }
  std::vector<double> ms;
  for (int i = 0; i < 200; ++i) {
    const auto start = steady_clock::now();
    if (test::ask(port, "GET", "/v1/scenes").status != 200) throw std::runtime_error("not answered");
    ms.push_back(std::chrono::duration<double, std::milli>(steady_clock::now() - start).count());
  }
  std::sort(ms.begin(), ms.end());
  report.section("a request beside 1000 idle and slow connections")
      .push_back({{{"request", "GET /v1/scenes"}},
                  {{"ms", median(ms)}, {"ms p99", ms[ms.size() * 99 / 100]}, {"ms most", ms.back()}}});
}

int run(double seconds, bool as_json) {
  ServeOptions options;
  options.scene = "builtin:helicopters";
  options.port = 0;
  options.access.requests_per_second = 0.0;
  RunningServer server(options, renderer_source("", ""));
  Report report;
  report.machine = {{"device", server.ready().get().device},
                    {"threads", std::to_string(std::thread::hardware_concurrency())}};
  while (test::ask(server.port(), "GET", "/v1/scenes").status != 200)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  measure_sessions(server.port(), seconds, report);
  measure_light_beside_heavy(server.port(), seconds, report);
  measure_watchers(server.port(), seconds, report);
  measure_idle(server.port(), report);
  as_json ? print_json(report, std::cout) : print_table(report, std::cout);
  return 0;
}

}  // namespace
}  // namespace lightwell::bench

int main(int count, char** arguments) {
  double seconds = 5.0;
  bool as_json = false;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--json") {
      as_json = true;
    } else if (argument == "--seconds" && i + 1 < count) {
      seconds = std::atof(arguments[++i]);
    } else {
      std::cerr << "usage: crowd_bench [--json] [--seconds N]\n";
      return 2;
    }
  }
  try {
    return lightwell::bench::run(seconds, as_json);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
