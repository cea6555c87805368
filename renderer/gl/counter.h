// A number that shaders count up and the host reads.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "renderer/gl/buffer.h"

namespace lightwell::gl {

class Counter {
 public:
  explicit Counter(std::string label) : word_(std::move(label), sizeof(std::uint32_t), BufferUse::kHostVisible) {}

  /// At 0, as the storage buffer `binding`.
  void begin(GLuint binding) {
    word_.clear();
    word_.bind_storage(binding);
  }

  /// What the commands so far have counted; waits for them, and orders their writes before what follows.
  std::uint32_t value() const {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    wait_for_device();
    std::uint32_t value = 0;
    std::memcpy(&value, word_.host(), sizeof value);
    return value;
  }

 private:
  Buffer word_;
};

}  // namespace lightwell::gl
