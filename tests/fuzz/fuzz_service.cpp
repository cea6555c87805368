// Everything behind the port, without the port: a request with its body is admitted, routed and answered; what follows
// the head of a stream are the stream's messages, one a line. SESSION stands for the id of a session that is there.
// No answer says that the server failed.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <iostream>
#include <string>

#include "server/http/message.h"
#include "server/net/body_decoder.h"
#include "server/random_id.h"
#include "server/service.h"
#include "tests/integration/fake_source.h"

namespace lightwell::test {
namespace {

using nlohmann::json;

const net::Peer kPeer{"127.0.0.1", 1};
constexpr int kMostPieces = 1000;  // of an answer that is made while it is sent

[[noreturn]] void fail(const std::string& what) {
  std::cerr << what << '\n';
  std::abort();
}

class Sink : public net::WebSocketLink {
 public:
  void wake() override {}
  void abort() override {}
};

class Subject {
 public:
  Subject() : studio_(std::make_shared<FakeStudio>()), folder_(make_folder()) {
    studio_->render_ms = 0;
    set_up_log(LogFormat::kText, LogLevel::kError);
    service_ = std::make_unique<Service>(options(), fake_source(studio_), [] { return 0; });
    service_->ready().wait();
    while (status_of(request("GET", "/v1/scenes")) != 200) std::this_thread::yield();
  }
  ~Subject() {
    service_.reset();
    std::filesystem::remove_all(folder_);
  }

  void serve(std::string text) {
    see_to_session();
    for (auto at = text.find("SESSION"); at != text.npos; at = text.find("SESSION", at + session_.size()))
      text.replace(at, 7, session_);
    static_cast<void>(exchange(text));
    std::lock_guard lock(studio_->mutex);
    studio_->log.clear();
  }

 private:
  static std::filesystem::path make_folder() {
    return std::filesystem::temp_directory_path() / ("fuzz_service-" + random_id());
  }

  ServeOptions options() const {
    ServeOptions options;
    options.scene = "builtin:cornell";
    options.data_dir = folder_.string();
    options.access.requests_per_second = 0.0;
    options.limits.max_size_px = 64;
    options.limits.max_spp_frames = 4;
    options.limits.max_sequence_frames = 4;
    options.limits.max_sequence_bytes = 1u << 20;
    options.limits.sequence_keep_s = 1.0;
    options.limits.session_idle_s = 1.0;
    options.limits.max_upload_bytes = 1u << 16;
    options.limits.max_scenes = 3;
    return options;
  }

  static std::string request(const std::string& method, const std::string& path, const std::string& body = {}) {
    const std::string content = "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size());
    return method + " " + path + " HTTP/1.1\r\nHost: localhost\r\n" + (body.empty() ? "" : content + "\r\n") + "\r\n" +
           body;
  }

  int status_of(const std::string& text) { return http::status_of(exchange(text)); }

  void see_to_session() {
    if (!session_.empty() && status_of(request("GET", "/v1/sessions/" + session_)) == 200) return;
    const std::string answer =
        exchange(request("POST", "/v1/sessions", R"({"scene":"cornell","width":8,"height":8,"idle_s":600})"));
    if (http::status_of(answer) != 201) return;  // as many as may be: until the idle ones have ended
    session_ = json::parse(answer.substr(answer.find("\r\n\r\n") + 4))["id"];
  }

  /// The answer; empty if none was asked for in full.
  std::string exchange(std::string_view text) {
    const net::HeadScan scan = net::find_head_end(text, 0);
    if (scan.state != net::HeadScan::State::kComplete) return {};
    auto parsed = net::parse_request_head(text.substr(0, scan.head_bytes));
    if (const auto* bad = std::get_if<net::Refusal>(&parsed))
      return checked(service_->refusal_response(*bad, false, nullptr));
    auto& head = std::get<net::RequestHead>(parsed);
    std::string_view rest = text.substr(scan.head_bytes);
    net::Admission admission = service_->admit(head, kPeer);
    if (const auto* bad = std::get_if<net::Refusal>(&admission))
      return checked(service_->refusal_response(*bad, false, &head));
    if (auto* web_socket = std::get_if<net::WebSocketAdmission>(&admission)) return converse(*web_socket, rest);
    net::BodyDecoder decoder(head, std::get<net::HttpAdmission>(admission).max_body_bytes);
    while (!rest.empty() && !decoder.done() && !decoder.failure()) rest.remove_prefix(decoder.feed(rest));
    if (!decoder.done()) return {};
    return ask({std::move(head), decoder.take_body(), kPeer, true, nullptr});
  }

  std::string ask(net::Request asked) {
    std::promise<net::Answer> promise;
    service_->answer(std::move(asked), [&](net::Answer answer) { promise.set_value(std::move(answer)); });
    const net::Answer answer = promise.get_future().get();
    if (answer.rest) {
      answer.rest->set_waker([] {});
      for (int i = 0; i < kMostPieces; ++i)
        if (const auto piece = answer.rest->next(); !piece || piece->empty()) break;
    }
    return checked(answer.bytes);
  }

  static std::string checked(std::string answer) {
    const int status = http::status_of(answer);
    if (status == 0 || status == 500) fail("the server failed: " + answer);
    return answer;
  }

  std::string converse(net::WebSocketAdmission& admission, std::string_view lines) {
    admission.handler->opened(std::make_shared<Sink>());
    const auto drain = [&] {
      for (int i = 0; i < kMostPieces; ++i) {
        const net::Outgoing sent = admission.handler->next();
        if (const auto* text = std::get_if<net::TextMessage>(&sent)) check_message(text->text);
        if (std::holds_alternative<std::monostate>(sent) || std::holds_alternative<net::CloseMessage>(sent)) break;
      }
    };
    drain();
    while (!lines.empty()) {
      const auto end = std::min(lines.find('\n'), lines.size());
      admission.handler->received_text(lines.substr(0, end));
      lines.remove_prefix(std::min(end + 1, lines.size()));
      drain();
    }
    admission.handler->closed();
    return {};
  }

  static void check_message(const std::string& text) {
    if (!protocol::parse_server_message(text)) fail("a message that no client can read: " + text);
  }

  std::shared_ptr<FakeStudio> studio_;
  const std::filesystem::path folder_;
  std::unique_ptr<Service> service_;
  std::string session_;
};

}  // namespace
}  // namespace lightwell::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static lightwell::test::Subject subject;
  subject.serve(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
