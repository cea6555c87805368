// What needs libavcodec, which brings 90 shared libraries: a module of its own, so that programs start without it and
// load it when video is first asked for. All but the module's own files go through video_encoder.h and film.h.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "renderer/error.h"

namespace lightwell::video_codecs {

struct Packet {
  bool is_key = false;
  std::vector<std::uint8_t> bytes;  // Annex B; a key has its parameter sets before it
};

/// Pictures of one size to packets, one for each at once, without B-frames. The first is a key. Not thread-safe.
class PacketEncoder {
 public:
  virtual ~PacketEncoder() = default;
  /// `rgbx`: 4 bytes a pixel of sRGB, row 0 at the top. `quality` as a JPEG's, 1..100.
  virtual Result<Packet> encode(std::span<const std::uint8_t> rgbx, int quality, bool want_key) = 0;
};

/// Pictures of one size to the bytes of one MP4 file that can be read while it is written. Not thread-safe.
class FilmEncoder {
 public:
  virtual ~FilmEncoder() = default;
  /// The next picture, as in PacketEncoder. Gives what the file goes on with, often nothing.
  virtual Result<std::string> add(std::span<const std::uint8_t> rgbx) = 0;
  /// The end of the file.
  virtual Result<std::string> finish() = 0;
};

/// The functions of the module. Sizes are even.
struct Table {
  bool (*can_encode)();  // there is an encoder of H.264
  Result<std::unique_ptr<PacketEncoder>> (*open_packets)(glm::ivec2 size_px, int quality);
  Result<std::unique_ptr<FilmEncoder>> (*open_film)(glm::ivec2 size_px, double fps);
};

bool can_encode();
Result<std::unique_ptr<PacketEncoder>> open_packets(glm::ivec2 size_px, int quality);
Result<std::unique_ptr<FilmEncoder>> open_film(glm::ivec2 size_px, double fps);

}  // namespace lightwell::video_codecs

/// What the module is asked for by name.
extern "C" __attribute__((visibility("default"))) const lightwell::video_codecs::Table* lightwell_video_codecs();
