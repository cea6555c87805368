// Textures and the framebuffers drawn into: move-only, freed with their owner, labelled for debuggers.
#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <string>

#include "renderer/gl/gl.h"
#include "renderer/gl/memory.h"

namespace lightwell::gl {

struct TextureOptions {
  GLenum target = GL_TEXTURE_2D;  // or GL_TEXTURE_2D_ARRAY
  int layers = 1;
  int levels = 1;
  GLenum min_filter = GL_NEAREST;
  GLenum mag_filter = GL_NEAREST;
  GLenum wrap = GL_CLAMP_TO_EDGE;
};

/// An immutable-storage texture.
class Texture {
 public:
  Texture() = default;
  /// `format` is a sized internal format: GL_RGBA16F, ... Throws std::runtime_error if the device has no memory for it.
  Texture(std::string label, GLenum format, glm::ivec2 size_px, const TextureOptions& options = {});
  ~Texture();
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;

  GLuint id() const { return id_; }
  GLenum format() const { return format_; }
  glm::ivec2 size_px() const { return size_px_; }
  int layers() const { return layers_; }
  bool is_array() const { return array_; }
  explicit operator bool() const { return id_ != 0; }

  void bind(GLuint unit) const { glBindTextureUnit(unit, id_); }
  /// As an image of all layers; `access` is GL_READ_ONLY, GL_WRITE_ONLY or GL_READ_WRITE.
  void bind_image(GLuint unit, GLenum access) const;
  void clear(const glm::vec4& value) const;

 private:
  GLuint id_ = 0;
  GLenum format_ = 0;
  glm::ivec2 size_px_{0};
  int layers_ = 1;
  bool array_ = false;
  Allocation memory_;
};

class Buffer;

/// A buffer read as a one-dimensional array of texels.
class BufferTexture {
 public:
  /// `format`: GL_RGBA32UI, ...
  BufferTexture(std::string label, GLenum format);
  ~BufferTexture();
  BufferTexture(const BufferTexture&) = delete;
  BufferTexture& operator=(const BufferTexture&) = delete;

  /// Reads from `buffer` as it is now; again after the buffer was reallocated.
  void attach(const Buffer& buffer) const;
  void bind(GLuint unit) const { glBindTextureUnit(unit, id_); }

 private:
  GLuint id_ = 0;
  GLenum format_;
};

/// A framebuffer over textures that outlive it.
class Framebuffer {
 public:
  Framebuffer() = default;
  /// `depth` may be null. Layered textures are attached at `layer`.
  Framebuffer(std::string label, std::initializer_list<const Texture*> colors, const Texture* depth, int layer = 0);
  ~Framebuffer();
  Framebuffer(Framebuffer&& other) noexcept;
  Framebuffer& operator=(Framebuffer&& other) noexcept;

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  /// Binds for drawing and sets the viewport to the whole.
  void bind() const;

 private:
  GLuint id_ = 0;
  glm::ivec2 size_px_{0};
};

/// An empty vertex array, for draws that make their vertices from gl_VertexID.
class EmptyVertexArray {
 public:
  EmptyVertexArray() { glCreateVertexArrays(1, &id_); }
  ~EmptyVertexArray() { glDeleteVertexArrays(1, &id_); }
  EmptyVertexArray(const EmptyVertexArray&) = delete;
  EmptyVertexArray& operator=(const EmptyVertexArray&) = delete;
  /// One triangle that covers the viewport.
  void draw_full_screen() const;

 private:
  GLuint id_ = 0;
};

}  // namespace lightwell::gl
