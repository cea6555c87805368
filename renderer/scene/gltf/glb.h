// The binary container of glTF 2.0: a header and chunks, of which the first holds the JSON and the second the bytes.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace lightwell::gltf {

struct GlbChunks {
  std::string_view json;
  std::span<const std::byte> binary;  // empty if there is no such chunk
};

/// Whether the bytes begin with the container's signature.
bool is_glb(std::span<const std::byte> bytes);

/// Views of the chunks within `bytes`. Throws Failure on anything but a whole container of version 2.
GlbChunks split_glb(std::span<const std::byte> bytes);

}  // namespace lightwell::gltf
