// A server as a process of its own, and a viewer of it that measures; no decoding.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/codec.h"
#include "protocol/frame_header.h"
#include "tests/integration/stream_client.h"

namespace lightwell::bench {

/// Of the steady clock, as the server's capture times are.
double now_ms();

/// The value below which that share of them lies; 0 if there are none.
double share_below(std::vector<double> values, double share);

/// A port that is free now.
int free_port();

/// `lightwell serve builtin:helicopters` as a child, stopped when this goes.
class ServerProcess {
 public:
  /// `options`: further ones of `serve`.
  ServerProcess(const std::string& program, int port, const std::vector<std::string>& options = {});
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  /// Throws if the server has ended by itself before its scenes were there.
  void wait_until_scenes_are_there() const;
  pid_t id() const { return child_; }

 private:
  int port_;
  pid_t child_ = -1;
};

/// A stream of a session of its own, 512 x 512, which acknowledges every frame at once. Throws std::runtime_error when
/// the stream ends or the server refuses something.
class Viewer {
 public:
  struct Seen {
    protocol::FrameHeader header;
    double arrived_ms = 0.0;
    /// Everything but rendering: waiting for an encoder, encoding, the socket, the client's loop.
    double added_ms() const { return arrived_ms - header.capture_ms - static_cast<double>(header.render_ms); }
  };

  /// `port`: the server's, or of a line to it.
  /// `patch`: side of the thesis' patches; `method`: its name in the API.
  Viewer(int port, bool playing, int patch = 2, const std::string& method = "thesis");

  /// None if none comes in time.
  std::optional<Seen> frame_within(std::chrono::milliseconds limit);
  Seen next_frame();
  /// Moves the camera: the input's number.
  std::uint32_t send_camera();
  /// Moves the camera; milliseconds until a picture of it is here, and that picture.
  std::pair<double, Seen> move_camera();

  const std::vector<double>& encode_ms() const { return encode_ms_; }

 private:
  void send(const protocol::ClientMessage& message) { socket_.send_text(protocol::serialize(message)); }
  void hear(const std::string& text);

  test::WebSocketClient socket_;
  std::uint32_t seq_ = 0;
  std::vector<double> encode_ms_;
};

}  // namespace lightwell::bench
