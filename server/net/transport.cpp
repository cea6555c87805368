#include "server/net/transport.h"

#include <poll.h>

namespace lightwell::net {

using std::chrono::steady_clock;

PeerState peer_state(int socket) {
  pollfd seen{socket, POLLRDHUP, 0};
  if (::poll(&seen, 1, 0) <= 0) return PeerState::kOpen;
  if (seen.revents & (POLLERR | POLLHUP | POLLNVAL)) return PeerState::kGone;
  return seen.revents & POLLRDHUP ? PeerState::kHalfClosed : PeerState::kOpen;
}

SteadyTime transfer_deadline(const ServerOptions& options, SteadyTime start, std::uint64_t bytes) {
  const std::chrono::duration<double> allowed(static_cast<double>(bytes) / options.min_bytes_per_s);
  const auto slowest = start + options.stall_timeout + std::chrono::duration_cast<steady_clock::duration>(allowed);
  return std::min(steady_clock::now() + options.stall_timeout, slowest);
}

}  // namespace lightwell::net
