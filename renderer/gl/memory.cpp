#include "renderer/gl/memory.h"

#include <atomic>
#include <string_view>
#include <utility>

#include "renderer/gl/gl.h"

namespace lightwell::gl {
namespace {

std::atomic<std::uint64_t> all_allocations = 0;

bool has_extension(std::string_view name) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i)
    if (name == reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)))) return true;
  return false;
}

std::uint64_t kibibytes(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value > 0 ? static_cast<std::uint64_t>(value) << 10 : 0;
}

}  // namespace

DeviceMemory device_memory() {
  constexpr GLenum kDedicatedNvx = 0x9047, kCurrentlyAvailableNvx = 0x9049;
  DeviceMemory memory;
  memory.own_bytes = all_allocations;
  if (!has_extension("GL_NVX_gpu_memory_info")) return memory;
  memory.total_bytes = kibibytes(kDedicatedNvx);
  const std::uint64_t free_bytes = kibibytes(kCurrentlyAvailableNvx);
  memory.used_bytes = memory.total_bytes > free_bytes ? memory.total_bytes - free_bytes : 0;
  return memory;
}

Allocation::Allocation(std::uint64_t bytes) : bytes_(bytes) {
  all_allocations += bytes_;
}

Allocation::~Allocation() {
  all_allocations -= bytes_;
}

Allocation::Allocation(Allocation&& other) noexcept : bytes_(std::exchange(other.bytes_, 0)) {}

Allocation& Allocation::operator=(Allocation&& other) noexcept {
  if (this == &other) return *this;
  all_allocations -= bytes_;
  bytes_ = std::exchange(other.bytes_, 0);
  return *this;
}

}  // namespace lightwell::gl
