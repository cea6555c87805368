// A TCP line on loopback that is as slow as a link far away: so many bits a second towards the client, so much delay.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace lightwell::bench {

class SlowLink {
 public:
  /// Listens on a port of its own for connections to `target_port`. `bits_per_s`: towards the client; the other way
  /// only the delay counts.
  SlowLink(int target_port, double bits_per_s, double round_trip_ms);
  ~SlowLink();
  SlowLink(const SlowLink&) = delete;
  SlowLink& operator=(const SlowLink&) = delete;

  int port() const { return port_; }

 private:
  void accept();
  void forward(int from, int to, double bytes_per_s);

  const int target_port_;
  const double bytes_per_s_, one_way_ms_;
  int listener_ = -1, port_ = 0;
  std::atomic<bool> stopping_ = false;
  std::vector<int> sockets_;
  std::vector<std::thread> forwarders_;
  std::thread acceptor_;
};

}  // namespace lightwell::bench
