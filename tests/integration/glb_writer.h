// The smallest .glb files, made in code.
#pragma once

#include <cstdint>
#include <string>

namespace lightwell::test {

inline void append_u32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((value >> shift) & 0xff));
}

/// A container of a JSON chunk and, if given, a binary one.
inline std::string glb_of_json(std::string text, std::string binary = {}) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string chunks;
  append_u32(chunks, static_cast<std::uint32_t>(text.size()));
  chunks += "JSON" + text;
  if (!binary.empty()) {
    append_u32(chunks, static_cast<std::uint32_t>(binary.size()));
    chunks += std::string("BIN\0", 4) + binary;
  }
  std::string file = "glTF";
  append_u32(file, 2);
  append_u32(file, static_cast<std::uint32_t>(12 + chunks.size()));
  return file + chunks;
}

/// One triangle of one metre, `times` over in the same place.
inline std::string triangle_glb(int times = 1) {
  std::string binary;
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  binary.append(reinterpret_cast<const char*>(positions), sizeof(positions));
  std::string roots = "0", nodes = R"({"name":"only","mesh":0})";
  for (int i = 1; i < times; ++i) {
    roots += "," + std::to_string(i);
    nodes += R"(,{"mesh":0})";
  }
  return glb_of_json(
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes + "]," +
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
          R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
          R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})",
      binary);
}

}  // namespace lightwell::test
