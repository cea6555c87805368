// Behind the connection layer, for tests of it and for suites from outside: answers requests in words, sends back what
// a WebSocket brings.
#pragma once

#include <deque>

#include "server/net/server.h"

namespace lightwell::test {

/// Sends every message back as it came. Says goodbye with 1000 to nobody: the other side ends it.
class EchoSocket : public net::WebSocketHandler {
 public:
  void opened(std::shared_ptr<net::WebSocketLink> link) override { link_ = std::move(link); }
  void received_text(std::string_view text) override { send(net::TextMessage{std::string(text)}); }
  void received_binary(std::string_view bytes) override {
    send(net::BinaryMessage{{}, std::make_shared<const std::vector<std::uint8_t>>(bytes.begin(), bytes.end())});
  }
  net::Outgoing next() override {
    if (waiting_.empty()) return {};
    net::Outgoing message = std::move(waiting_.front());
    waiting_.pop_front();
    return message;
  }
  void closed() override { link_.reset(); }

 protected:
  void send(net::Outgoing message) {
    waiting_.push_back(std::move(message));
    link_->wake();
  }

 private:
  std::shared_ptr<net::WebSocketLink> link_;
  std::deque<net::Outgoing> waiting_;
};

/// Answers any request with its body, or, where it has none, with its method and path; opens a WebSocket on any path.
class EchoApplication : public net::Application {
 public:
  explicit EchoApplication(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  net::Admission admit(const net::RequestHead& head, const net::Peer&) override {
    if (head.wants_web_socket) return net::WebSocketAdmission{std::make_shared<EchoSocket>(), {}, max_bytes_};
    return net::HttpAdmission{max_bytes_};
  }
  void answer(net::Request request, std::function<void(net::Answer)> done) override {
    const net::RequestHead& head = request.head;
    const std::string words = request.body.empty() ? head.method + " " + head.path : request.body;
    done({response(200, words, request.keep_alive), nullptr});
  }
  std::string refusal_response(const net::Refusal& refusal, bool keep_alive, const net::RequestHead*) override {
    return response(refusal.status, refusal.detail, keep_alive);
  }

 private:
  static std::string response(int status, const std::string& body, bool keep_alive) {
    return "HTTP/1.1 " + std::to_string(status) + " Word\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
           (keep_alive ? "" : "Connection: close\r\n") + "\r\n" + body;
  }

  const std::uint64_t max_bytes_;
};

}  // namespace lightwell::test
