// A GL buffer object: move-only, freed with its owner, labelled for debuggers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "renderer/gl/gl.h"
#include "renderer/gl/memory.h"

namespace lightwell::gl {

/// Who touches the bytes, which decides where they live.
enum class BufferUse {
  kDevice,       // written and read by the device; filled by `upload` at most
  kHostVisible,  // persistently and coherently mapped as well: `host()` is valid for the buffer's life
};

class Buffer {
 public:
  Buffer() = default;
  /// Throws std::runtime_error if the device refuses the size. `size_bytes` 0 is raised to 16.
  Buffer(std::string label, std::uint64_t size_bytes, BufferUse use = BufferUse::kDevice);
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  GLuint id() const { return id_; }
  std::uint64_t size_bytes() const { return size_bytes_; }
  explicit operator bool() const { return id_ != 0; }

  /// The mapped bytes, or null for kDevice.
  std::byte* host() const { return host_; }

  /// Copies into the buffer at `offset_bytes`, ordered with GL commands.
  void upload(std::span<const std::byte> bytes, std::uint64_t offset_bytes = 0);
  template <class T>
  void upload(std::span<const T> values, std::uint64_t offset_bytes = 0) {
    upload(std::as_bytes(values), offset_bytes);
  }

  /// Reads back synchronously.
  void download(std::span<std::byte> bytes, std::uint64_t offset_bytes = 0) const;

  /// Fills with a 32-bit word.
  void clear(std::uint32_t word = 0);

  void bind_storage(GLuint binding) const;  // GL_SHADER_STORAGE_BUFFER
  void bind_uniform(GLuint binding) const;

  /// Grows (never shrinks) to at least `size_bytes`, dropping the contents; true if it was reallocated.
  bool reserve(std::uint64_t size_bytes);

 private:
  void release();
  GLuint id_ = 0;
  std::uint64_t size_bytes_ = 0;
  BufferUse use_ = BufferUse::kDevice;
  std::byte* host_ = nullptr;
  std::string label_;
  Allocation memory_;
};

/// Waits until the device has done all commands issued so far and host-visible buffers show their results.
void wait_for_device();

}  // namespace lightwell::gl
