#include "renderer/gl/fence.h"

#include <utility>

namespace lightwell::gl {

Fence& Fence::operator=(Fence&& other) noexcept {
  std::swap(sync_, other.sync_);
  return *this;
}

void Fence::set() {
  release();
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void Fence::wait() {
  constexpr GLuint64 kOneSecondNs = 1'000'000'000;
  while (sync_ && glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kOneSecondNs) == GL_TIMEOUT_EXPIRED) {
  }
  release();
}

void Fence::release() {
  if (sync_) glDeleteSync(sync_);
  sync_ = nullptr;
}

}  // namespace lightwell::gl
