// Buffers that are filled anew in every frame, mostly with what they hold already.
#pragma once

#include <bit>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "renderer/gl/buffer.h"

namespace lightwell {

/// Replaces the buffer's contents if they differ from `uploaded`, what it was filled with last.
template <class T>
void upload_if_changed(gl::Buffer& buffer, std::vector<T>& uploaded, std::vector<T> wanted) {
  const std::size_t size_bytes = wanted.size() * sizeof(T);
  if (wanted.size() == uploaded.size() &&
      (wanted.empty() || std::memcmp(wanted.data(), uploaded.data(), size_bytes) == 0))
    return;
  uploaded = std::move(wanted);
  buffer.reserve(std::bit_ceil(std::uint64_t{size_bytes}));
  buffer.upload(std::span<const T>(uploaded));
}

}  // namespace lightwell
