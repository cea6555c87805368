// Shader programs: sources compiled into the binary (or read from the folder in LIGHTWELL_SHADER_DIR while developing),
// #include expanded, programs cached so that every view shares them.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/gl/gl.h"

namespace lightwell::gl {

class Buffer;

/// A linked program. Move-only; made by ShaderLibrary.
class Program {
 public:
  Program(std::string label, GLuint id) : label_(std::move(label)), id_(id) {}
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  GLuint id() const { return id_; }
  const std::string& label() const { return label_; }
  void use() const { glUseProgram(id_); }

  /// Dispatches a compute program over at least `size` invocations in groups of `group`, as the shader declares them.
  void dispatch(glm::ivec2 size, glm::ivec2 group = {8, 8}) const;
  void dispatch(std::uint32_t size, std::uint32_t group = 64) const;
  /// Dispatches as many groups as the first three words of `arguments` say.
  void dispatch_indirect(const Buffer& arguments) const;

 private:
  std::string label_;
  GLuint id_;
};

using ProgramPtr = std::shared_ptr<const Program>;

/// A uniform whose location is looked up once. Setting one that the compiler removed does nothing.
template <class T>
class Uniform {
 public:
  Uniform(const ProgramPtr& program, const char* name)
      : program_(program->id()), location_(glGetUniformLocation(program->id(), name)) {}
  void operator=(const T& value) const { set(program_, location_, value); }
  Uniform(const Uniform&) = default;
  Uniform& operator=(const Uniform&) = delete;

 private:
  static void set(GLuint p, GLint l, int v) { glProgramUniform1i(p, l, v); }
  static void set(GLuint p, GLint l, std::uint32_t v) { glProgramUniform1ui(p, l, v); }
  static void set(GLuint p, GLint l, float v) { glProgramUniform1f(p, l, v); }
  static void set(GLuint p, GLint l, const glm::ivec2& v) { glProgramUniform2i(p, l, v.x, v.y); }
  static void set(GLuint p, GLint l, const glm::vec2& v) { glProgramUniform2f(p, l, v.x, v.y); }
  static void set(GLuint p, GLint l, const glm::vec3& v) { glProgramUniform3f(p, l, v.x, v.y, v.z); }
  static void set(GLuint p, GLint l, const glm::vec4& v) { glProgramUniform4f(p, l, v.x, v.y, v.z, v.w); }
  static void set(GLuint p, GLint l, const glm::uvec4& v) { glProgramUniform4ui(p, l, v.x, v.y, v.z, v.w); }
  static void set(GLuint p, GLint l, const glm::mat4& v) { glProgramUniformMatrix4fv(p, l, 1, GL_FALSE, &v[0][0]); }
  GLuint program_;
  GLint location_;
};

/// Compiles and keeps programs. Sources are named by their path below renderer/: "passes/compose.frag".
/// Texts have no #version; the library adds `#version 450 core` and the defines. `#include "shaders/brdf.glsl"` names
/// a source likewise; each is included once.
class ShaderLibrary {
 public:
  ShaderLibrary();

  /// Defines are "NAME VALUE". Throw std::runtime_error with the compiler's log, its lines named by file.
  ProgramPtr compute(std::string_view path, const std::vector<std::string>& defines = {});
  /// A compute program of the given text, which may include the library's sources; `label` names it in the log.
  ProgramPtr compute_text(const std::string& label, const std::string& text,
                          const std::vector<std::string>& defines = {});
  ProgramPtr raster(std::string_view vertex_path, std::string_view fragment_path,
                    const std::vector<std::string>& defines = {});

 private:
  std::string source_of(std::string_view path) const;
  std::string directory_;  // empty: the embedded sources
  std::map<std::string, ProgramPtr> programs_;
};

}  // namespace lightwell::gl
