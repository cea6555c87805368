// The shaders' texts, compiled into the binary; paths are relative to renderer/: "passes/g_buffer.frag".
#pragma once

#include <functional>
#include <map>
#include <string>

namespace lightwell::gl {

const std::map<std::string, std::string, std::less<>>& embedded_shader_sources();

}  // namespace lightwell::gl
