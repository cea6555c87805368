// A session's picture, encoded once and shared among all who watch it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages.h"
#include "server/video/video_encoder.h"

namespace lightwell {

/// What moves by itself, as it stands in one picture.
struct Placement {
  protocol::FreeCamera view;
  std::vector<protocol::LightEntry> lights;

  bool operator==(const Placement&) const = default;
};

/// What pictures are to be made as for those who watch.
struct PictureNeed {
  bool jpeg = false;
  bool video = false;
  bool key = false;                // someone can begin with the video, or go on, at a key alone
  bool is_paced_by_video = false;  // who has the link that pictures are made for takes video
};

struct Picture {
  std::uint64_t source = 0;                               // the audience it was made for
  std::uint64_t number = 0;                               // ascending within the source
  std::uint64_t revision = 0;                             // of the state it shows
  std::uint64_t scene_revision = 0;                       // of the session
  std::shared_ptr<const std::vector<std::uint8_t>> file;  // JPEG; null: everyone takes the video
  std::optional<VideoPacket> video;                       // none: everyone takes the file
  bool is_final = false;
  double capture_ms = 0.0;
  std::uint16_t width = 0, height = 0;
  protocol::Stats stats;  // fps is filled in by who sends it
  std::shared_ptr<const Placement> placement;
};

/// Milliseconds of the server's clock: steady, from an arbitrary beginning.
double server_clock_ms();

}  // namespace lightwell
