#include "tests/bench/slow_link.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <deque>
#include <stdexcept>
#include <string>

namespace lightwell::bench {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kPacketBytes = 1448;
constexpr double kBottleneckS = 0.06;  // what waits at the narrow place at most; the rest stays with the sender
constexpr int kSmallBuffer = 32 * 1024;

steady_clock::duration in_seconds(double seconds) {
  return std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(seconds));
}

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int new_socket() {
  const int on = 1, socket = ::socket(AF_INET, SOCK_STREAM, 0);
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kSmallBuffer, sizeof(kSmallBuffer));
  return socket;
}

struct Packet {
  std::string bytes;
  steady_clock::time_point there;
};

}  // namespace

SlowLink::SlowLink(int target_port, double bits_per_s, double round_trip_ms)
    : target_port_(target_port),
      bytes_per_s_(bits_per_s / 8.0),
      one_way_ms_(round_trip_ms / 2.0),
      listener_(new_socket()) {
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof(address);
  if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || ::listen(listener_, 16) != 0)
    throw std::runtime_error("no port for the slow link");
  ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  acceptor_ = std::thread([this] { accept(); });
}

SlowLink::~SlowLink() {
  stopping_ = true;
  acceptor_.join();
  for (const int socket : sockets_) ::shutdown(socket, SHUT_RDWR);
  for (std::thread& forwarder : forwarders_) forwarder.join();
  for (const int socket : sockets_) ::close(socket);
  ::close(listener_);
}

void SlowLink::accept() {
  while (!stopping_) {
    pollfd ready{listener_, POLLIN, 0};
    if (::poll(&ready, 1, 50) <= 0) continue;
    const int near = ::accept(listener_, nullptr, nullptr), far = new_socket(), on = 1;
    ::setsockopt(near, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    const sockaddr_in target = loopback(target_port_);
    sockets_.insert(sockets_.end(), {near, far});
    if (near < 0 || ::connect(far, reinterpret_cast<const sockaddr*>(&target), sizeof(target)) != 0) continue;
    forwarders_.emplace_back([this, near, far] { forward(near, far, 1e12); });
    forwarders_.emplace_back([this, near, far] { forward(far, near, bytes_per_s_); });
  }
}

/// Reads no more than waits at the narrow place, so that the sender's TCP feels it.
void SlowLink::forward(int from, int to, double bytes_per_s) {
  std::deque<Packet> packets;
  steady_clock::time_point free_at{};  // when the narrow place has let all through that came
  bool open = true;
  while ((open || !packets.empty()) && !stopping_) {
    const auto now = steady_clock::now();
    if (!packets.empty() && packets.front().there <= now) {
      const std::string& bytes = packets.front().bytes;
      if (::send(to, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0) return;
      packets.pop_front();
      continue;
    }
    const bool room = open && free_at - now < in_seconds(kBottleneckS);
    timespec wait{0, 500'000};
    pollfd ready{from, static_cast<short>(room ? POLLIN : 0), 0};
    if (::ppoll(&ready, room ? 1 : 0, &wait, nullptr) <= 0) continue;
    std::string bytes(kPacketBytes, '\0');
    const ssize_t count = ::recv(from, bytes.data(), bytes.size(), 0);
    open = count > 0;
    if (!open) continue;
    bytes.resize(static_cast<std::size_t>(count));
    free_at = std::max(free_at, steady_clock::now()) + in_seconds(static_cast<double>(count) / bytes_per_s);
    packets.push_back({std::move(bytes), free_at + in_seconds(one_way_ms_ / 1e3)});
  }
  ::shutdown(to, SHUT_WR);
}

}  // namespace lightwell::bench
