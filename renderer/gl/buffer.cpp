#include "renderer/gl/buffer.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "renderer/check.h"
#include "renderer/gl/fence.h"

namespace lightwell::gl {

Buffer::Buffer(std::string label, std::uint64_t size_bytes, BufferUse use)
    : size_bytes_(std::max<std::uint64_t>(size_bytes, 16)), use_(use), label_(std::move(label)) {
  glCreateBuffers(1, &id_);
  const GLbitfield map_flags = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const GLbitfield flags = GL_DYNAMIC_STORAGE_BIT | (use == BufferUse::kHostVisible ? map_flags : 0u);
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(size_bytes_), nullptr, flags);
  GLint64 actual_bytes = 0;
  glGetNamedBufferParameteri64v(id_, GL_BUFFER_SIZE, &actual_bytes);
  if (actual_bytes != static_cast<GLint64>(size_bytes_)) {
    glDeleteBuffers(1, &id_);
    throw std::runtime_error("the device refused a buffer of " + std::to_string(size_bytes_) + " bytes for " + label_);
  }
  memory_ = Allocation(size_bytes_);
  glObjectLabel(GL_BUFFER, id_, -1, label_.c_str());
  if (use == BufferUse::kHostVisible) {
    host_ = static_cast<std::byte*>(glMapNamedBufferRange(id_, 0, static_cast<GLsizeiptr>(size_bytes_), map_flags));
    if (!host_) throw std::runtime_error("the device cannot map the buffer " + label_);
  }
}

Buffer::~Buffer() {
  release();
}

Buffer::Buffer(Buffer&& other) noexcept {
  *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this == &other) return *this;
  release();
  id_ = std::exchange(other.id_, 0);
  size_bytes_ = std::exchange(other.size_bytes_, 0);
  use_ = other.use_;
  host_ = std::exchange(other.host_, nullptr);
  label_ = std::move(other.label_);
  memory_ = std::move(other.memory_);
  return *this;
}

void Buffer::release() {
  if (id_ != 0) glDeleteBuffers(1, &id_);
  id_ = 0;
  host_ = nullptr;
  memory_ = {};
}

void Buffer::upload(std::span<const std::byte> bytes, std::uint64_t offset_bytes) {
  if (bytes.empty()) return;
  LIGHTWELL_CHECK_OP(offset_bytes + bytes.size(), <=, size_bytes_);
  glNamedBufferSubData(id_, static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

void Buffer::download(std::span<std::byte> bytes, std::uint64_t offset_bytes) const {
  if (bytes.empty()) return;
  LIGHTWELL_CHECK_OP(offset_bytes + bytes.size(), <=, size_bytes_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(bytes.size()),
                          bytes.data());
}

void Buffer::clear(std::uint32_t word) {
  glClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void Buffer::bind_storage(GLuint binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}

void Buffer::bind_uniform(GLuint binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, id_);
}

bool Buffer::reserve(std::uint64_t size_bytes) {
  if (id_ != 0 && size_bytes <= size_bytes_) return false;
  *this = Buffer(label_, size_bytes, use_);
  return true;
}

void wait_for_device() {
  Fence fence;
  fence.set();
  fence.wait();
}

}  // namespace lightwell::gl
