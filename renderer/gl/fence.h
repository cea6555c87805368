// A place in the order of GL commands that can be waited for.
#pragma once

#include "renderer/gl/gl.h"

namespace lightwell::gl {

/// Move-only; of no effect until it is set.
class Fence {
 public:
  Fence() = default;
  ~Fence() { release(); }
  Fence(Fence&& other) noexcept : sync_(other.sync_) { other.sync_ = nullptr; }
  Fence& operator=(Fence&& other) noexcept;

  /// Behind all commands issued so far; what they write is then seen in host-visible buffers.
  void set();
  explicit operator bool() const { return sync_ != nullptr; }
  /// Until the device has come to it; it is then not set any more.
  void wait();

 private:
  void release();
  GLsync sync_ = nullptr;
};

}  // namespace lightwell::gl
