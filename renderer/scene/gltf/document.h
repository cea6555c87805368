// A glTF file taken apart: its objects as tinygltf's plain structs, its buffers and encoded images as bytes.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/gltf/asset_files.h"
#include "renderer/scene/gltf/diagnostics.h"
#include "renderer/scene/gltf/load_gltf.h"

namespace lightwell::gltf {

/// What tinygltf and Scene both say for an index that is not given.
inline constexpr int kNone = -1;

struct ImageSource {
  std::string name;
  std::string uri;          // if not empty, where the encoded image is
  int buffer_view = kNone;  // else this
};

struct Document {
  tinygltf::Model model;  // all but `buffers` and `images`; indices are not negative, but may be out of range
  std::vector<std::span<const std::byte>> buffers;
  std::vector<ImageSource> images;
  std::vector<Bytes> owned;  // what `buffers` shows of data that is not part of the file itself
};

/// Takes apart the JSON of a glTF file and fetches its buffers. `binary` is what a buffer without a URI holds, and must
/// outlive the result. tinygltf sees neither buffers nor images nor files, only JSON that the schema has approved.
/// Throws Failure.
Document read_document(std::string_view json, std::span<const std::byte> binary, AssetFiles& files,
                       const LoadLimits& limits, Warnings& warnings);

/// The bytes of a buffer view. Throws Failure if it does not exist or does not lie within its buffer.
std::span<const std::byte> bytes_of_view(const Document& document, int buffer_view, const std::string& where);

/// The element with that index. Throws Failure if there is none.
template <class T>
const T& at(const std::vector<T>& elements, int index, const std::string& where) {
  if (index < 0 || static_cast<std::size_t>(index) >= elements.size())
    fail(where, "there is no " + std::to_string(index) + ": there are " + std::to_string(elements.size()));
  return elements[static_cast<std::size_t>(index)];
}

/// What of `extensions` has the name, or null.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name);

/// Members of a tinygltf object that the schema has approved. `fallback` stands for a missing one.
double number_or(const tinygltf::Value& object, const char* name, double fallback);
int index_or(const tinygltf::Value& object, const char* name, int fallback);

}  // namespace lightwell::gltf
