#include "tests/integration/line.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace lightwell::test {

using std::chrono::steady_clock;

Line::Line(int port) {
  socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    throw std::runtime_error("cannot connect to the server under test");
}

Line::~Line() {
  if (socket_ >= 0) ::close(socket_);
}

Line::Line(Line&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), closed_(other.closed_), rest_(std::move(other.rest_)) {}

bool Line::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

void Line::shut_down_sending() {
  ::shutdown(socket_, SHUT_WR);
}

void Line::reset() {
  const linger at_once{1, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
  ::close(std::exchange(socket_, -1));
}

bool Line::receive_some(std::string& into, steady_clock::time_point deadline) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now());
  pollfd ready{socket_, POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0))) <= 0) return false;
  char buffer[65536];
  const ssize_t count = ::recv(socket_, buffer, sizeof(buffer), 0);
  closed_ = count <= 0;
  if (!closed_) into.append(buffer, static_cast<std::size_t>(count));
  return !closed_;
}

std::string Line::receive_until(std::string_view until, std::chrono::milliseconds limit) {
  const auto deadline = steady_clock::now() + limit;
  std::string text = std::exchange(rest_, {});
  std::size_t found = text.find(until);
  while (found == std::string::npos && receive_some(text, deadline)) found = text.find(until);
  if (found == std::string::npos) return text;
  rest_ = text.substr(found + until.size());
  text.resize(found + until.size());
  return text;
}

std::string Line::receive(std::size_t bytes, std::chrono::milliseconds limit) {
  const auto deadline = steady_clock::now() + limit;
  std::string text = std::exchange(rest_, {});
  while (text.size() < bytes && receive_some(text, deadline)) {
  }
  if (text.size() > bytes) rest_ = text.substr(bytes);
  text.resize(std::min(text.size(), bytes));
  return text;
}

std::string Line::receive_all(std::chrono::milliseconds limit) {
  const auto deadline = steady_clock::now() + limit;
  std::string text = std::exchange(rest_, {});
  while (receive_some(text, deadline)) {
  }
  return text;
}

std::string Answer::field(std::string_view name) const {
  const std::string start = "\r\n" + std::string(name) + ": ";
  const auto at = head.find(start);
  if (at == std::string::npos) return {};
  return head.substr(at + start.size(), head.find("\r\n", at + 2) - at - start.size());
}

Answer read_answer(Line& line, bool head_only, std::chrono::milliseconds limit) {
  Answer answer;
  do {
    answer.head = line.receive_until("\r\n\r\n", limit);
  } while (answer.head.starts_with("HTTP/1.1 100 "));
  if (!answer.head.starts_with("HTTP/1.1 ") || !answer.head.ends_with("\r\n\r\n")) return answer;
  answer.status = std::stoi(answer.head.substr(9, 3));
  const std::string length = answer.field("Content-Length");
  if (head_only || length.empty()) return answer;
  answer.body = line.receive(std::stoul(length), limit);
  return answer;
}

Answer ask(int port, const std::string& method, const std::string& target, const std::string& body,
           const std::string& content_type, const std::string& more_fields) {
  Line line(port);
  std::string request = method + " " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                        "\r\nConnection: close\r\n" + more_fields;
  if (!body.empty() || method == "POST" || method == "PUT" || method == "PATCH")
    request += "Content-Type: " + content_type + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n";
  line.send(request + "\r\n" + body);
  return read_answer(line, method == "HEAD");
}

}  // namespace lightwell::test
