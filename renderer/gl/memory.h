// How much of the device's memory is taken: what the device tells, and an account of our own objects.
#pragma once

#include <cstdint>

namespace lightwell::gl {

struct DeviceMemory {
  std::uint64_t total_bytes = 0;  // of the device; 0: it does not tell
  std::uint64_t used_bytes = 0;   // of it, by everyone; 0: it does not tell
  std::uint64_t own_bytes = 0;    // in textures and buffers of this process, without what a driver adds
};

/// Of the current context's device: GL_NVX_gpu_memory_info tells its total and what is free, others do not.
DeviceMemory device_memory();

/// Bytes on the account of our own objects, for as long as it lives. Thread-safe.
class Allocation {
 public:
  Allocation() = default;
  explicit Allocation(std::uint64_t bytes);
  ~Allocation();
  Allocation(Allocation&& other) noexcept;
  Allocation& operator=(Allocation&& other) noexcept;

 private:
  std::uint64_t bytes_ = 0;
};

}  // namespace lightwell::gl
