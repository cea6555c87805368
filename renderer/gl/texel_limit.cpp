#include "renderer/gl/texel_limit.h"

#include <stdexcept>

#include "renderer/gl/gl.h"

namespace lightwell::gl {

void check_texels(std::uint64_t bytes, std::uint64_t texel_bytes, const std::string& what) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  if (bytes / texel_bytes > static_cast<std::uint64_t>(limit))
    throw std::runtime_error("the scene's " + what + " take " + std::to_string(bytes >> 20) +
                             " MiB; the device allows " + std::to_string((std::uint64_t(limit) * texel_bytes) >> 20));
}

}  // namespace lightwell::gl
