#include "renderer/tracing/device_pool.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "renderer/check.h"

namespace lightwell {
namespace {

constexpr std::uint64_t kFirstBytes = 64 * 1024;

std::uint32_t most_elements(std::uint32_t element_bytes) {
  GLint64 most_bytes = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most_bytes);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(static_cast<std::uint64_t>(most_bytes) / element_bytes,
                                                            std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace

PoolRange::~PoolRange() {
  if (pool_) pool_->free(first_, count_);
}

PoolRange::PoolRange(PoolRange&& other) noexcept
    : pool_(std::exchange(other.pool_, nullptr)), first_(other.first_), count_(other.count_) {}

PoolRange& PoolRange::operator=(PoolRange&& other) noexcept {
  std::swap(pool_, other.pool_);
  std::swap(first_, other.first_);
  std::swap(count_, other.count_);
  return *this;
}

DevicePool::DevicePool(std::string label, std::uint32_t element_bytes)
    : label_(std::move(label)), element_bytes_(element_bytes), most_(most_elements(element_bytes)) {
  grow(static_cast<std::uint32_t>(kFirstBytes / element_bytes_));
}

PoolRange DevicePool::allocate(std::uint32_t count) {
  if (count == 0) return {};
  auto space = std::find_if(free_.begin(), free_.end(), [&](const auto& entry) { return entry.second >= count; });
  if (space == free_.end()) {
    grow(count);
    space = std::prev(free_.end());  // growth ends the buffer with a free range that is large enough
  }
  const auto [first, available] = *space;
  free_.erase(space);
  if (available > count) free_.emplace(first + count, available - count);
  return {this, first, count};
}

void DevicePool::grow(std::uint32_t least_count) {
  // Half as much again, so that many small meshes are copied a few times only.
  const std::uint64_t wanted = std::uint64_t{capacity_} + std::max<std::uint64_t>(least_count, capacity_ / 2);
  const std::uint64_t least = std::uint64_t{capacity_} + least_count;
  if (least > most_)
    throw std::runtime_error("the scene needs " + std::to_string(least * element_bytes_ >> 20) + " MiB of " + label_ +
                             ", more than a shader of this device can address");
  const auto grown = static_cast<std::uint32_t>(std::min<std::uint64_t>(wanted, most_));
  gl::Buffer buffer(label_, std::uint64_t{grown} * element_bytes_);
  if (capacity_ > 0)
    glCopyNamedBufferSubData(buffer_.id(), buffer.id(), 0, 0,
                             static_cast<GLsizeiptr>(std::uint64_t{capacity_} * element_bytes_));
  buffer_ = std::move(buffer);
  const std::uint32_t first = capacity_;
  capacity_ = grown;
  free(first, grown - first);
}

void DevicePool::free(std::uint32_t first, std::uint32_t count) {
  const auto [entry, is_new] = free_.emplace(first, count);
  LIGHTWELL_CHECK(is_new);
  const auto next = std::next(entry);
  if (next != free_.end() && entry->first + entry->second == next->first) {
    entry->second += next->second;
    free_.erase(next);
  }
  if (entry == free_.begin()) return;
  const auto previous = std::prev(entry);
  if (previous->first + previous->second != entry->first) return;
  previous->second += entry->second;
  free_.erase(entry);
}

}  // namespace lightwell
