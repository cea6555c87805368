// A whole server in the test's process, on a free port, with a fake source of pictures unless told otherwise.
#pragma once

#include <gtest/gtest.h>

#include "protocol/codec.h"
#include "protocol/frame_header.h"
#include "server/running_server.h"
#include "tests/integration/fake_source.h"
#include "tests/integration/line.h"
#include "tests/integration/stream_client.h"

namespace lightwell::test {

using nlohmann::json;

inline ServeOptions test_options() {
  ServeOptions options;
  options.scene = "builtin:cornell";
  options.port = 0;
  options.reference_after_s = 0.0;         // a final picture stays
  options.access.requests_per_second = 0;  // tests ask often
  options.limits.max_upload_bytes = 4u << 20;
  options.limits.max_sessions = 8;
  options.limits.max_scenes = 3;
  return options;
}

/// Waits until pictures of all scenes can be asked for.
inline void wait_until_ready(const RunningServer& server) {
  server.ready().wait();
  while (ask(server.port(), "GET", "/v1/scenes").status != 200)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

/// A request as it goes over the line.
inline std::string post_text(const std::string& path, const std::string& body) {
  return "POST " + path + " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

class ServerTest : public testing::Test {
 protected:
  explicit ServerTest(const ServeOptions& options = test_options())
      : studio_(std::make_shared<FakeStudio>()), server_(options, fake_source(studio_)) {
    wait_until_ready(server_);
  }

  Answer ask(const std::string& method, const std::string& target, const std::string& body = {},
             const std::string& content_type = "application/json", const std::string& more_fields = {}) const {
    return test::ask(server_.port(), method, target, body, content_type, more_fields);
  }
  Answer ask(const std::string& method, const std::string& target, const char* body) const {
    return ask(method, target, std::string(body));
  }
  Answer ask(const std::string& method, const std::string& target, const json& body) const {
    return ask(method, target, body.dump());
  }

  /// A session's id.
  std::string make_session(json more = json::object()) const {
    more.merge_patch({{"scene", more.value("scene", "cornell")}});
    if (!more.contains("width")) more["width"] = more["height"] = 64;
    const Answer answer = ask("POST", "/v1/sessions", more);
    EXPECT_EQ(answer.status, 201) << answer.body;
    return json::parse(answer.body).value("id", "");
  }

  /// A number that /metrics tells; -1 if it does not.
  double metric(const std::string& name) const {
    const std::string text = ask("GET", "/metrics").body;
    const auto at = text.find("\n" + name + " ");
    return at == std::string::npos ? -1.0 : std::stod(text.substr(at + name.size() + 2));
  }

  std::shared_ptr<FakeStudio> studio_;
  RunningServer server_;
};

/// The problem document in an answer; fails the test if it is none.
inline json problem(const Answer& answer) {
  EXPECT_EQ(answer.field("Content-Type"), "application/problem+json") << answer.head << answer.body;
  const json document = json::parse(answer.body, nullptr, false);
  EXPECT_EQ(document.value("status", 0), answer.status);
  EXPECT_FALSE(document.value("title", "").empty());
  EXPECT_FALSE(document.value("detail", "").empty());
  return document;
}

/// A picture with its header, or a text message.
struct Heard {
  std::optional<protocol::FrameHeader> frame;
  std::string payload;  // of the frame
  json text;
};

/// One stream: says hello by itself, acknowledges only when told to.
class StreamClient {
 public:
  explicit StreamClient(int port, const std::string& session, const WebSocketClient::Options& options = {}) {
    status_ = socket_.open(port, "/v1/sessions/" + session + "/stream", options);
  }

  int status() const { return status_; }
  WebSocketClient& socket() { return socket_; }

  /// Gives the welcome.
  json hello(json more = json::object()) {
    json message{{"type", "hello"},         {"codecs", {"jpeg"}}, {"width", 64},      {"height", 64},
                 {"device_pixel_ratio", 1}, {"role", "driver"},   {"resume", nullptr}};
    message.update(more);
    send(message);
    return next_text("welcome");
  }

  void send(const json& message) { socket_.send_text(message.dump()); }
  void input(std::uint32_t seq, json members) {
    members.update({{"type", "input"}, {"seq", seq}});
    send(members);
  }
  void ack(std::uint32_t frame) {
    send({{"type", "ack"}, {"frame", frame}, {"received_ms", 0}, {"decoded_ms", 0}, {"shown_ms", 0}, {"queue", 0}});
  }

  std::optional<Heard> next(std::chrono::milliseconds limit = kPatience) {
    const auto message = socket_.receive(limit);
    if (!message) return {};
    Heard heard;
    if (message->is_text) {
      heard.text = json::parse(message->bytes);
      return heard;
    }
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(message->bytes.data());
    const auto decoded = protocol::decode_frame({bytes, message->bytes.size()});
    EXPECT_TRUE(decoded.ok()) << (decoded ? "" : decoded.problem().detail);
    if (!decoded) return {};
    heard.frame = decoded->header;
    heard.payload.assign(decoded->payload.begin(), decoded->payload.end());
    return heard;
  }

  /// The next text message of a type; null if none came in time. Frames and other messages on the way are passed over.
  json next_text(const std::string& type, std::chrono::milliseconds limit = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (auto heard = next(remaining(deadline)))
      if (heard->text.is_object() && heard->text.value("type", "") == type) return heard->text;
    return nullptr;
  }

  /// The next frame, text messages passed over.
  std::optional<protocol::FrameHeader> next_frame(std::chrono::milliseconds limit = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (auto heard = next(remaining(deadline)))
      if (heard->frame) return heard->frame;
    return {};
  }

  /// Acknowledges every frame until one satisfies `enough`.
  template <class Enough>
  std::optional<protocol::FrameHeader> frame_where(const Enough& enough, std::chrono::milliseconds limit = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (auto frame = next_frame(remaining(deadline))) {
      ack(frame->frame);
      if (enough(*frame)) return frame;
    }
    return {};
  }

  /// The code it closes with; what comes before is passed over.
  int close_code(std::chrono::milliseconds limit = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (socket_.close_code() == 0 && std::chrono::steady_clock::now() < deadline) next(remaining(deadline));
    return socket_.close_code();
  }

 private:
  static std::chrono::milliseconds remaining(std::chrono::steady_clock::time_point deadline) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    return std::max(left, std::chrono::milliseconds(0));
  }

  WebSocketClient socket_;
  int status_ = 0;
};

}  // namespace lightwell::test
