// A server of the connection layer alone, with an application of the tests' own behind it.
#pragma once

#include <gtest/gtest.h>

#include <mutex>
#include <thread>

#include "server/net/server.h"
#include "tests/integration/echo_application.h"
#include "tests/integration/line.h"

namespace lightwell::test {

inline std::string response(int status, const std::string& body, bool keep_alive) {
  return "HTTP/1.1 " + std::to_string(status) + " Word\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
         (keep_alive ? "" : "Connection: close\r\n") + "\r\n" + body;
}

/// Sends every message back, what is binary after a head of its own; says goodbye when told to close.
class Echo : public EchoSocket {
 public:
  void received_text(std::string_view text) override {
    if (text == "close") return send(net::CloseMessage{4321, "as you wish"});
    EchoSocket::received_text(text);
  }
  void received_binary(std::string_view bytes) override {
    send(net::BinaryMessage{"head:", std::make_shared<const std::vector<std::uint8_t>>(bytes.begin(), bytes.end())});
  }
};

/// Six bytes, two at a time, as they are let go.
class Drip : public net::BodySource {
 public:
  std::optional<std::string> next() override {
    std::lock_guard lock(mutex_);
    if (sent_ == 3) return {};
    if (sent_ == ready_) return std::string();
    return std::string(2, static_cast<char>('a' + sent_++));
  }
  void set_waker(std::function<void()> wake) override {
    std::lock_guard lock(mutex_);
    wake_ = std::move(wake);
  }
  void let_go() {
    std::lock_guard lock(mutex_);
    ++ready_;
    if (wake_) wake_();
  }

 private:
  std::mutex mutex_;
  std::function<void()> wake_;
  int ready_ = 0, sent_ = 0;
};

/// Answers with what was asked: "/slow" after a while, "/long" when let go, "/drip" bit by bit, "/refused" never.
class TestApplication : public net::Application {
 public:
  ~TestApplication() override {
    for (std::thread& thread : threads_) thread.join();
  }

  net::Admission admit(const net::RequestHead& head, const net::Peer&) override {
    if (head.wants_web_socket) return net::WebSocketAdmission{std::make_shared<Echo>(), "echo", 1000};
    if (head.path == "/refused") return net::Refusal{403, "no", {}};
    return net::HttpAdmission{1'000'000};
  }

  void answer(net::Request request, std::function<void(net::Answer)> done) override {
    std::lock_guard lock(mutex_);
    threads_.emplace_back([this, request = std::move(request), done = std::move(done)] {
      if (request.head.path == "/slow") std::this_thread::sleep_for(std::chrono::milliseconds(200));
      if (request.head.path == "/long") {
        ++long_begun;
        comes_true([&] { return let_go || *request.gone; });
        if (*request.gone) ++long_called_off;
      }
      if (request.head.path == "/drip") {
        drip = std::make_shared<Drip>();
        return done({"HTTP/1.1 200 OK\r\nContent-Length: 6\r\n\r\n", drip});
      }
      done({response(200, request.head.method + " " + request.head.path + " " + request.body, request.keep_alive), {}});
    });
  }

  std::string refusal_response(const net::Refusal& refusal, bool keep_alive, const net::RequestHead*) override {
    return response(refusal.status, refusal.detail, keep_alive);
  }

  std::atomic<int> long_begun = 0, long_called_off = 0;  // requests for /long
  std::atomic<bool> let_go = false;                      // ends them
  std::shared_ptr<Drip> drip;

 private:
  std::mutex mutex_;
  std::vector<std::thread> threads_;
};

/// The application goes before the server, and the server has stopped by then: late answers go nowhere.
class ConnectionTest : public testing::Test {
 protected:
  explicit ConnectionTest(const net::ServerOptions& options = {}) : server_(options) { server_.start(application_); }
  ~ConnectionTest() override { server_.stop(); }

  int port() const { return server_.port(); }
  bool all_are_closed() const {
    return comes_true([this] { return server_.connections() == 0; });
  }

  net::Server server_;
  TestApplication application_;
};

}  // namespace lightwell::test
