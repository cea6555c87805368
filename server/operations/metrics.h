// What the server counts and measures, for Prometheus. Thread-safe; each call costs a few atomic additions.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "renderer/gl/memory.h"
#include "renderer/renderer.h"

namespace lightwell {

/// What a picture was rendered for.
enum class Purpose { kStream, kRequest };

/// What stands at a value rather than counts up, asked when the metrics are.
struct Levels {
  std::uint64_t sessions = 0, viewers = 0, connections = 0;
  std::uint64_t renders_waiting = 0;  // requests for pictures that are not answered yet
  // Of sequences, not rendered yet; none: their table cannot be read.
  std::optional<std::uint64_t> frames_waiting = 0;
  std::uint64_t uploaded_scenes = 0, uploaded_bytes = 0;
  bool ready = false;
};

/// What a stream's picture was made as; 0 bytes: not as that.
struct EncodedBytes {
  std::uint64_t jpeg = 0, h264 = 0;
};
enum class PictureCodec { kJpeg, kH264 };

class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void frame_rendered(const Frame& frame, Purpose purpose, double seconds);
  void frame_failed(ErrorKind kind);
  void picture_encoded(double seconds, const EncodedBytes& bytes);
  void encoding_failed(PictureCodec codec);
  void picture_sent(PictureCodec codec, std::uint64_t bytes);
  /// From a frame's being sent to its being acknowledged.
  void picture_acknowledged(double seconds);
  /// `route` is the template of the path ("/v1/scenes/{name}"), or "none" if there is no such path.
  void request_answered(std::string_view method, std::string_view route, int status, double seconds);
  void bytes_received(std::uint64_t bytes);
  void device_memory(const gl::DeviceMemory& memory);
  void device_rebuilt();
  /// Work that is done again and again has failed this time.
  void background_task_failed(std::string_view task);
  /// A session of another server goes on at this one.
  void session_taken_up();

  /// The text format of Prometheus, version 0.0.4.
  std::string exposition(const Levels& levels) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightwell
