// One storage buffer shared by many meshes: space is handed out and taken back, so that a new mesh uploads only itself.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "renderer/gl/buffer.h"

namespace lightwell {

class DevicePool;

/// Space in a DevicePool, given back with its owner. Move-only; the pool must outlive it.
class PoolRange {
 public:
  PoolRange() = default;
  PoolRange(DevicePool* pool, std::uint32_t first, std::uint32_t count) : pool_(pool), first_(first), count_(count) {}
  ~PoolRange();
  PoolRange(PoolRange&& other) noexcept;
  PoolRange& operator=(PoolRange&& other) noexcept;

  std::uint32_t first() const { return first_; }
  std::uint32_t count() const { return count_; }

 private:
  DevicePool* pool_ = nullptr;
  std::uint32_t first_ = 0, count_ = 0;
};

class DevicePool {
 public:
  /// Counts in elements of `element_bytes`.
  DevicePool(std::string label, std::uint32_t element_bytes);
  DevicePool(const DevicePool&) = delete;
  DevicePool& operator=(const DevicePool&) = delete;

  /// `count` elements that stay where they are. The buffer may grow, by a copy on the device.
  /// Throws std::runtime_error if the device cannot hold them. A count of 0 takes no space.
  PoolRange allocate(std::uint32_t count);

  /// Fills a range from its first element on.
  template <class T>
  void upload(const PoolRange& range, std::span<const T> values) {
    buffer_.upload(std::as_bytes(values), std::uint64_t{range.first()} * element_bytes_);
  }

  void bind_storage(GLuint binding) const { buffer_.bind_storage(binding); }
  std::uint64_t size_bytes() const { return buffer_.size_bytes(); }

 private:
  friend class PoolRange;
  void grow(std::uint32_t least_count);
  void free(std::uint32_t first, std::uint32_t count);

  std::string label_;
  std::uint32_t element_bytes_;
  std::uint32_t capacity_ = 0;  // elements
  std::uint32_t most_ = 0;      // elements a shader can address
  gl::Buffer buffer_;
  std::map<std::uint32_t, std::uint32_t> free_;  // first element -> count; neighbours are always merged
};

}  // namespace lightwell
