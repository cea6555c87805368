#include "renderer/gl/program.h"

#include "renderer/gl/buffer.h"

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "renderer/gl/shader_sources.h"

namespace lightwell::gl {

namespace {

// One translation unit: the text with its includes, and which file each #line number stands for.
struct Expansion {
  std::string text;
  std::vector<std::string> files;
  std::set<std::string> included;
};

template <class Read>
void expand(const std::string& path, const Read& read, Expansion& out) {
  constexpr std::size_t kMostFiles = 64;
  if (!out.included.insert(path).second) return;
  if (out.files.size() >= kMostFiles) throw std::runtime_error("more than 64 shader files included by " + path);
  const std::size_t file = out.files.size();
  out.files.push_back(path);
  out.text += "#line 1 " + std::to_string(file) + "\n";
  std::istringstream lines(read(path));
  std::string line;
  int number = 0;
  while (std::getline(lines, line)) {
    ++number;
    constexpr std::string_view kInclude = "#include \"";
    if (line.starts_with(kInclude)) {
      const std::size_t end = line.find('"', kInclude.size());
      if (end == std::string::npos) throw std::runtime_error(path + ":" + std::to_string(number) + ": open #include");
      expand(line.substr(kInclude.size(), end - kInclude.size()), read, out);
      out.text += "#line " + std::to_string(number + 1) + " " + std::to_string(file) + "\n";
    } else {
      out.text += line + "\n";
    }
  }
}

GLuint compile(GLenum stage, const Expansion& source, const std::vector<std::string>& defines) {
  std::string text = "#version 450 core\n";
  for (const std::string& define : defines) text += "#define " + define + "\n";
  text += source.text;
  const GLuint shader = glCreateShader(stage);
  const char* pointer = text.c_str();
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::string log(8192, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  glDeleteShader(shader);
  std::string files;
  for (std::size_t i = 0; i < source.files.size(); ++i) files += "\n  " + std::to_string(i) + " = " + source.files[i];
  throw std::runtime_error("shader " + source.files[0] + " does not compile:\n" + log + "files:" + files);
}

GLuint link(const std::string& label, const std::vector<GLuint>& shaders) {
  const GLuint program = glCreateProgram();
  for (const GLuint shader : shaders) glAttachShader(program, shader);
  glLinkProgram(program);
  for (const GLuint shader : shaders) {
    glDetachShader(program, shader);
    glDeleteShader(shader);
  }
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (good) {
    glObjectLabel(GL_PROGRAM, program, -1, label.c_str());
    return program;
  }
  std::string log(8192, '\0');
  GLsizei length = 0;
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  glDeleteProgram(program);
  throw std::runtime_error("program " + label + " does not link:\n" + log);
}

std::string key_of(std::string label, const std::vector<std::string>& defines) {
  for (const std::string& define : defines) label += " " + define;
  return label;
}

}  // namespace

Program::~Program() {
  glDeleteProgram(id_);
}

void Program::dispatch(glm::ivec2 size, glm::ivec2 group) const {
  use();
  const glm::ivec2 groups = (size + group - 1) / group;
  glDispatchCompute(static_cast<GLuint>(groups.x), static_cast<GLuint>(groups.y), 1);
}

void Program::dispatch(std::uint32_t size, std::uint32_t group) const {
  use();
  // A dimension is limited to 65535 groups: larger dispatches go to two dimensions and the shader flattens them.
  constexpr std::uint32_t kMostGroups = 65535;
  const std::uint32_t groups = (size + group - 1) / group;
  const std::uint32_t rows = (groups + kMostGroups - 1) / kMostGroups;
  if (groups > 0) glDispatchCompute((groups + rows - 1) / rows, rows, 1);
}

void Program::dispatch_indirect(const Buffer& arguments) const {
  use();
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments.id());
  glDispatchComputeIndirect(0);
}

ShaderLibrary::ShaderLibrary() {
  const char* directory = std::getenv("LIGHTWELL_SHADER_DIR");
  if (directory) directory_ = directory;
}

std::string ShaderLibrary::source_of(std::string_view path) const {
  if (!directory_.empty()) {
    std::ifstream file(directory_ + "/" + std::string(path));
    if (!file) throw std::runtime_error("no shader " + directory_ + "/" + std::string(path));
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  const auto& sources = embedded_shader_sources();
  const auto found = sources.find(path);
  if (found == sources.end()) throw std::runtime_error("no shader " + std::string(path));
  return found->second;
}

ProgramPtr ShaderLibrary::compute(std::string_view path, const std::vector<std::string>& defines) {
  const ProgramPtr known = programs_[key_of(std::string(path), defines)];
  return known ? known : compute_text(std::string(path), source_of(path), defines);
}

ProgramPtr ShaderLibrary::compute_text(const std::string& label, const std::string& text,
                                       const std::vector<std::string>& defines) {
  ProgramPtr& program = programs_[key_of(label, defines)];
  if (program) return program;
  Expansion source;
  expand(
      label, [&](const std::string& file) { return file == label ? text : source_of(file); }, source);
  program = std::make_shared<Program>(label, link(label, {compile(GL_COMPUTE_SHADER, source, defines)}));
  return program;
}

ProgramPtr ShaderLibrary::raster(std::string_view vertex_path, std::string_view fragment_path,
                                 const std::vector<std::string>& defines) {
  const std::string label = std::string(vertex_path) + " + " + std::string(fragment_path);
  ProgramPtr& program = programs_[key_of(label, defines)];
  if (program) return program;
  const auto read = [this](const std::string& file) { return source_of(file); };
  Expansion vertex, fragment;
  expand(std::string(vertex_path), read, vertex);
  expand(std::string(fragment_path), read, fragment);
  const GLuint vertex_shader = compile(GL_VERTEX_SHADER, vertex, defines);
  program =
      std::make_shared<Program>(label, link(label, {vertex_shader, compile(GL_FRAGMENT_SHADER, fragment, defines)}));
  return program;
}

}  // namespace lightwell::gl
