#include "renderer/gl/texture.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "renderer/check.h"
#include "renderer/gl/buffer.h"

namespace lightwell::gl {
namespace {

/// Of a texture that has storage, as its format says.
std::uint64_t bytes_of(GLuint id, const TextureOptions& options) {
  std::uint64_t bits = 0;
  const auto value = [id](int level, GLenum name) {
    GLint result = 0;
    glGetTextureLevelParameteriv(id, level, name, &result);
    return static_cast<std::uint64_t>(result);
  };
  for (const GLenum channel : {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE,
                               GL_TEXTURE_DEPTH_SIZE, GL_TEXTURE_STENCIL_SIZE, GL_TEXTURE_SHARED_SIZE})
    bits += value(0, channel);
  std::uint64_t pixels = 0;
  for (int level = 0; level < options.levels; ++level)
    pixels += value(level, GL_TEXTURE_WIDTH) * value(level, GL_TEXTURE_HEIGHT);
  return pixels * static_cast<std::uint64_t>(options.layers) * bits / 8;
}

}  // namespace

Texture::Texture(std::string label, GLenum format, glm::ivec2 size_px, const TextureOptions& options)
    : format_(format), size_px_(size_px), layers_(options.layers), array_(options.target == GL_TEXTURE_2D_ARRAY) {
  LIGHTWELL_CHECK_OP(size_px.x, >, 0);
  LIGHTWELL_CHECK_OP(size_px.y, >, 0);
  while (glGetError() != GL_NO_ERROR) {
  }
  glCreateTextures(options.target, 1, &id_);
  if (options.target == GL_TEXTURE_2D_ARRAY)
    glTextureStorage3D(id_, options.levels, format, size_px.x, size_px.y, options.layers);
  else
    glTextureStorage2D(id_, options.levels, format, size_px.x, size_px.y);
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) {
    glDeleteTextures(1, &id_);
    throw std::runtime_error("the device refused a texture of " + std::to_string(size_px.x) + "x" +
                             std::to_string(size_px.y) + "x" + std::to_string(options.layers) + " for " + label);
  }
  memory_ = Allocation(bytes_of(id_, options));
  glObjectLabel(GL_TEXTURE, id_, -1, label.c_str());
  glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(options.min_filter));
  glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(options.mag_filter));
  glTextureParameteri(id_, GL_TEXTURE_WRAP_S, static_cast<GLint>(options.wrap));
  glTextureParameteri(id_, GL_TEXTURE_WRAP_T, static_cast<GLint>(options.wrap));
}

Texture::~Texture() {
  if (id_ != 0) glDeleteTextures(1, &id_);
}

Texture::Texture(Texture&& other) noexcept {
  *this = std::move(other);
}

Texture& Texture::operator=(Texture&& other) noexcept {
  if (this == &other) return *this;
  if (id_ != 0) glDeleteTextures(1, &id_);
  id_ = std::exchange(other.id_, 0);
  format_ = other.format_;
  size_px_ = std::exchange(other.size_px_, glm::ivec2(0));
  layers_ = other.layers_;
  array_ = other.array_;
  memory_ = std::move(other.memory_);
  return *this;
}

void Texture::bind_image(GLuint unit, GLenum access) const {
  glBindImageTexture(unit, id_, 0, GL_TRUE, 0, access, format_);
}

void Texture::clear(const glm::vec4& value) const {
  glClearTexImage(id_, 0, GL_RGBA, GL_FLOAT, &value[0]);
}

BufferTexture::BufferTexture(std::string label, GLenum format) : format_(format) {
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &id_);
  glObjectLabel(GL_TEXTURE, id_, -1, label.c_str());
}

BufferTexture::~BufferTexture() {
  glDeleteTextures(1, &id_);
}

void BufferTexture::attach(const Buffer& buffer) const {
  glTextureBuffer(id_, format_, buffer.id());
}

Framebuffer::Framebuffer(std::string label, std::initializer_list<const Texture*> colors, const Texture* depth,
                         int layer) {
  glCreateFramebuffers(1, &id_);
  glObjectLabel(GL_FRAMEBUFFER, id_, -1, label.c_str());
  const auto attach = [&](GLenum point, const Texture& texture) {
    if (texture.is_array())
      glNamedFramebufferTextureLayer(id_, point, texture.id(), 0, layer);
    else
      glNamedFramebufferTexture(id_, point, texture.id(), 0);
    size_px_ = texture.size_px();
  };
  std::vector<GLenum> draw_buffers;
  for (const Texture* color : colors) {
    draw_buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(draw_buffers.size()));
    attach(draw_buffers.back(), *color);
  }
  if (depth) attach(GL_DEPTH_ATTACHMENT, *depth);
  glNamedFramebufferDrawBuffers(id_, static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
  LIGHTWELL_CHECK_OP(glCheckNamedFramebufferStatus(id_, GL_DRAW_FRAMEBUFFER), ==,
                     static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
}

Framebuffer::~Framebuffer() {
  if (id_ != 0) glDeleteFramebuffers(1, &id_);
}

Framebuffer::Framebuffer(Framebuffer&& other) noexcept {
  *this = std::move(other);
}

Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
  if (this == &other) return *this;
  if (id_ != 0) glDeleteFramebuffers(1, &id_);
  id_ = std::exchange(other.id_, 0);
  size_px_ = other.size_px_;
  return *this;
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id_);
  glViewport(0, 0, size_px_.x, size_px_.y);
}

void EmptyVertexArray::draw_full_screen() const {
  glBindVertexArray(id_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace lightwell::gl
