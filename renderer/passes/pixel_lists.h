// The pixels that get rays of their own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/gl/buffer.h"

namespace lightwell {

/// Which pixels get rays; made by passes/compose.frag.
class PixelLists {
 public:
  PixelLists();
  void resize(glm::ivec2 size_px);

  /// Before the picture is composed: empty.
  void begin();
  /// After it: how many there are of each kind. Waits for the device.
  void count();

  void bind() const;
  /// Of all unmatched pixels, the share that gets rays: as many as there is room for, by the number in the last frame.
  float unmatched_share() const { return unmatched_share_; }
  std::uint32_t most_unmatched() const { return most_unmatched_; }

  const gl::Buffer& reflecting() const { return reflecting_; }
  const gl::Buffer& unmatched() const { return unmatched_; }
  std::uint32_t reflecting_count() const { return reflecting_count_; }
  std::uint32_t unmatched_count() const { return listed_count_; }

 private:
  gl::Buffer counts_, reflecting_, unmatched_;
  std::uint32_t most_unmatched_ = 0, reflecting_count_ = 0, listed_count_ = 0;
  float unmatched_share_ = 1.0f;
};

}  // namespace lightwell
