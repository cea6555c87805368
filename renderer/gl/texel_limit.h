// How much a shader can read through a buffer texture.
#pragma once

#include <cstdint>
#include <string>

namespace lightwell::gl {

/// Throws std::runtime_error, which names `what` of the scene, if a buffer texture of this device cannot have `bytes`
/// in texels of `texel_bytes`.
void check_texels(std::uint64_t bytes, std::uint64_t texel_bytes, const std::string& what);

}  // namespace lightwell::gl
