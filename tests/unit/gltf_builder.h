// Builds small .glb files for tests: JSON as a value, binary data appended piece by piece.
#pragma once

#include <cstring>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "renderer/scene/gltf/load_gltf.h"
#include "tests/unit/png_writer.h"

namespace lightwell {

/// A component type of glTF.
template <class T>
constexpr int component_type() {
  if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
  if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
  if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
  if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
  if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
  if constexpr (std::is_same_v<T, float>) return 5126;
}

inline void append_little_endian(ByteVector& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

/// The container around JSON and binary data, each padded to four bytes as it must be.
inline ByteVector make_glb(std::string json, ByteVector binary) {
  while (json.size() % 4 != 0) json += ' ';
  while (binary.size() % 4 != 0) binary.push_back(std::byte{0});
  const std::size_t chunks = 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size());
  ByteVector out;
  append_little_endian(out, 0x46546c67);
  append_little_endian(out, 2);
  append_little_endian(out, static_cast<std::uint32_t>(12 + chunks));
  append_little_endian(out, static_cast<std::uint32_t>(json.size()));
  append_little_endian(out, 0x4e4f534a);
  for (const char character : json) out.push_back(static_cast<std::byte>(character));
  if (binary.empty()) return out;
  append_little_endian(out, static_cast<std::uint32_t>(binary.size()));
  append_little_endian(out, 0x004e4942);
  out.insert(out.end(), binary.begin(), binary.end());
  return out;
}

struct GltfBuilder {
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}};
  ByteVector binary;

  /// Appends to an array of the document; gives the new element's index.
  int add(const char* array, nlohmann::json element) {
    root[array].push_back(std::move(element));
    return static_cast<int>(root[array].size()) - 1;
  }

  /// A buffer view of raw bytes, which begin at a multiple of four.
  int add_view(std::span<const std::byte> bytes, int stride = 0) {
    while (binary.size() % 4 != 0) binary.push_back(std::byte{0});
    nlohmann::json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    binary.insert(binary.end(), bytes.begin(), bytes.end());
    return add("bufferViews", std::move(view));
  }

  template <class T>
  int add_view(const std::vector<T>& values, int stride = 0) {
    return add_view(std::as_bytes(std::span(values)), stride);
  }

  /// An accessor with a view of its own. `type` is SCALAR, VEC2 and so on.
  template <class T>
  int add_accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type[3] - '0');
    nlohmann::json accessor{{"bufferView", add_view(values)},
                            {"componentType", component_type<T>()},
                            {"count", values.size() / components},
                            {"type", type}};
    if (normalized) accessor["normalized"] = true;
    return add("accessors", std::move(accessor));
  }

  int add_image(const ByteVector& encoded) {
    return add("images", {{"bufferView", add_view(std::span<const std::byte>(encoded))}, {"mimeType", "image/png"}});
  }

  /// A texture of one white pixel.
  int add_texture() { return add("textures", {{"source", add_image(one_pixel_png())}}); }

  /// A mesh with one primitive, on a node of its own.
  int add_mesh(nlohmann::json primitive) {
    const int mesh = add("meshes", {{"primitives", {std::move(primitive)}}});
    add("nodes", {{"mesh", mesh}});
    return mesh;
  }

  /// The corners (0,0,0), (1,0,0), (0,1,0) as an accessor of positions.
  int add_triangle_positions() { return add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3"); }

  /// The simplest file that shows something.
  static GltfBuilder triangle() {
    GltfBuilder builder;
    builder.add_mesh({{"attributes", {{"POSITION", builder.add_triangle_positions()}}}});
    return builder;
  }

  nlohmann::json& primitive(int mesh = 0) { return root["meshes"][static_cast<std::size_t>(mesh)]["primitives"][0]; }

  ByteVector glb() const {
    nlohmann::json document = root;
    if (!binary.empty() && !document.contains("buffers")) document["buffers"] = {{{"byteLength", binary.size()}}};
    return make_glb(document.dump(), binary);
  }

  Result<Scene> load(const LoadLimits& limits = {}) const { return load_glb(glb(), limits); }
};

}  // namespace lightwell
