#include "tests/bench/stream_viewer.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "tests/integration/line.h"

namespace lightwell::bench {

using nlohmann::json;
using std::chrono::steady_clock;

double now_ms() {
  return std::chrono::duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

double share_below(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

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

ServerProcess::ServerProcess(const std::string& program, int port, const std::vector<std::string>& options)
    : port_(port) {
  std::vector<std::string> words{program, "serve", "builtin:helicopters", "--port", std::to_string(port)};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  child_ = ::fork();
  if (child_ == 0) {
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    ::execv(program.c_str(), arguments.data());
    ::_exit(127);
  }
}

ServerProcess::~ServerProcess() {
  ::kill(child_, SIGTERM);
  ::waitpid(child_, nullptr, 0);
}

void ServerProcess::wait_until_scenes_are_there() const {
  for (;;) {
    if (::waitpid(child_, nullptr, WNOHANG) != 0) throw std::runtime_error("the server ended by itself");
    try {
      if (test::ask(port_, "GET", "/v1/scenes").status == 200) return;
    } catch (const std::runtime_error&) {  // does not listen yet
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

Viewer::Viewer(int port, bool playing, int patch, const std::string& method) {
  const json request{{"scene", "helicopters"},
                     {"width", 512},
                     {"height", 512},
                     {"playing", playing},
                     {"time_s", 3.0},
                     {"settings",
                      {{"method", method},
                       {"samples", 32},
                       {"indirect_size", 128},
                       {"bounces", 1},
                       {"denoise", false},
                       {"patch", patch}}}};
  const test::Answer answer = test::ask(port, "POST", "/v1/sessions", request.dump());
  if (answer.status != 201) throw std::runtime_error("no session: " + answer.body);
  socket_.open(port, "/v1/sessions/" + json::parse(answer.body)["id"].get<std::string>() + "/stream");
  protocol::Hello hello;
  hello.codecs = {"jpeg"};
  hello.width = hello.height = 512;
  send(hello);
}

std::optional<Viewer::Seen> Viewer::frame_within(std::chrono::milliseconds limit) {
  const auto deadline = steady_clock::now() + limit;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now());
    const auto message = socket_.receive(std::max(left, std::chrono::milliseconds(0)));
    const double arrived_ms = now_ms();
    if (!message && socket_.close_code() == 0) return {};
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
    return Seen{frame->header, arrived_ms};
  }
}

Viewer::Seen Viewer::next_frame() {
  const auto seen = frame_within(test::kPatience);
  if (!seen) throw std::runtime_error("no frame came");
  return *seen;
}

std::uint32_t Viewer::send_camera() {
  protocol::Input input;
  input.seq = ++seq_;
  protocol::FreeCamera camera;
  camera.eye = {10.0 + 0.01 * seq_, 6.0, 14.0};
  camera.target = {0.0, 2.0, 0.0};
  input.change.camera = camera;
  send(input);
  return seq_;
}

std::pair<double, Viewer::Seen> Viewer::move_camera() {
  const double sent_ms = now_ms();
  const std::uint32_t seq = send_camera();
  for (;;) {
    const Seen seen = next_frame();
    if (seen.header.input_seq >= seq) return {seen.arrived_ms - sent_ms, seen};
  }
}

void Viewer::hear(const std::string& text) {
  const json message = json::parse(text);
  if (message["type"] == "stats") encode_ms_.push_back(message["encode_ms"]);
  if (message["type"] == "error") throw std::runtime_error(text);
}

}  // namespace lightwell::bench
